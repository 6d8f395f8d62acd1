// list.cpp
#include "apps/commands.h"

namespace zonal {

void add_list(CLI::App& app, int*) {
  app.add_subcommand("list", "not built yet");
}

}  // namespace zonal
