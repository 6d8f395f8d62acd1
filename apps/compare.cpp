// compare.cpp
#include "apps/commands.h"

namespace zonal {

void add_compare(CLI::App& app, int*) {
  app.add_subcommand("compare", "not built yet");
}

}  // namespace zonal
