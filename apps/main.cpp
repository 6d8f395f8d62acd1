// The `zonal` command: hands the arguments to a subcommand and turns every error into one line and an exit
// code.

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "apps/commands.h"
#include "core/error.h"

namespace zonal {

std::atomic<bool>& stop_asked() {
  static std::atomic<bool> asked{false};
  return asked;
}

void catch_interrupts() {
  static_assert(std::atomic<bool>::is_always_lock_free);  // or a signal handler could not set it
  stop_asked() = false;  // also builds the static before a signal can ask for it
  const auto handler = [](int signal) {
    stop_asked().store(true, std::memory_order_relaxed);
    std::signal(signal, SIG_DFL);
  };
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

namespace {

// The subcommand the user reached, or the program itself.
CLI::App* chosen(CLI::App& app) {
  const std::vector<CLI::App*> subcommands = app.get_subcommands();
  return subcommands.empty() ? &app : subcommands.front();
}

// One sentence about arguments nothing claimed, with the nearest name there is.
std::string unknown_argument(CLI::App& app) {
  CLI::App* command = chosen(app);
  const std::vector<std::string> extras = app.remaining(true);
  const std::string argument = extras.empty() ? "" : extras.front().substr(0, extras.front().find('='));
  std::vector<std::string> names;
  if (argument.rfind('-', 0) == 0) {
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return fmt::format("unknown option {}{}", argument, did_you_mean(argument, names));
  }
  if (command != &app)
    return fmt::format("unexpected argument \"{}\"; see zonal {} --help", argument, command->get_name());
  for (const CLI::App* subcommand : app.get_subcommands({})) names.push_back(subcommand->get_name());
  return fmt::format("unknown command \"{}\"{}", argument, did_you_mean(argument, names));
}

int complain(const std::string& sentence) {
  fmt::print(stderr, "zonal: {}\n", sentence);
  return kBadInput;
}

int run(int argc, char** argv) {
  int exit_code = kDone;
  CLI::App app("Renders a scene with an exchangeable lighting method and compares methods.", "zonal");
  app.set_version_flag("--version", "zonal " ZONAL_VERSION);
  add_render(app, &exit_code);
  add_compare(app, &exit_code);
  add_flight(app, &exit_code);
  add_list(app, &exit_code);
  add_material(app, &exit_code);
  add_reference(app, &exit_code);
  add_sweep(app, &exit_code);
  add_verify(app, &exit_code);
  add_view(app, &exit_code);

  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) return complain("expected a command; see zonal --help");
    return exit_code;
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ExtrasError&) {
    return complain(unknown_argument(app));
  } catch (const CLI::ParseError& error) {
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    const CLI::App* command = chosen(app);
    const std::string name = command == &app ? "" : command->get_name() + " ";
    return complain(fmt::format("{}; see zonal {}--help", line, name));
  } catch (const SceneError& error) {
    return complain(error.what());
  } catch (const std::bad_alloc&) {
    return complain("out of memory");
  } catch (const std::exception& error) {
    return complain(fmt::format("internal error: {}", error.what()));
  }
}

}  // namespace
}  // namespace zonal

int main(int argc, char** argv) {
  return zonal::run(argc, argv);
}
