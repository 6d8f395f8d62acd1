// reference.cpp
#include "apps/commands.h"

namespace zonal {

void add_reference(CLI::App& app, int*) {
  app.add_subcommand("reference", "not built yet");
}

}  // namespace zonal
