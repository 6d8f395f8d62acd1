#pragma once
/// What a run says of where it ran: part of --stats, image metadata and reports.

#include <cstddef>
#include <string>

namespace zonal {

std::string compiler_name();    ///< "clang 16.0.6"
std::string cpu_name();         ///< the processor's model name, or "unknown"
int hardware_threads();           ///< threads this process may use at once
std::size_t peak_memory_bytes();  ///< largest resident size of this process so far

}  // namespace zonal
