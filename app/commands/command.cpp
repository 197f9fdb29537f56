#include "commands/command.hpp"

#include <cstdio>
#include <exception>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/picture_size.hpp>

namespace trocar::app {

CLI::App* add_command(CLI::App& program, Chosen& chosen, const std::string& name, const std::string& what,
                      const std::string& example) {
  CLI::App* command = program.add_subcommand(name, what);
  command->footer("Example:\n  " + example);
  command->add_flag("--json", chosen.json, tr("print one JSON object on standard output"));
  return command;
}

void print(const Json& object) {
  const std::string text = object.dump(2, ' ', false, Json::error_handler_t::replace);
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

namespace {

int fail(const Chosen& chosen, int code, const std::string& message, const Json& faults) {
  fmt::print(stderr, "{}\n", message);
  if (chosen.json) {
    Json object{{"error", message}, {"exit", code}};
    if (!faults.empty()) object["faults"] = faults;
    print(object);
  }
  return code;
}

Json as_json(const std::vector<core::Fault>& faults) {
  Json list = Json::array();
  for (const core::Fault& f : faults)
    list.push_back({{"file", f.at.file}, {"line", f.at.line}, {"column", f.at.column}, {"message", tr(f.message.c_str())}});
  return list;
}

}  // namespace

int run_guarded(const Chosen& chosen) {
  try {
    return chosen.run();
  } catch (const core::BadInput& bad) {
    return fail(chosen, core::kBadInput, bad.what(), as_json(bad.faults()));
  } catch (const core::EnvironmentLacks& lacks) {
    return fail(chosen, core::kEnvironment, tr(lacks.what()), Json::array());
  } catch (const std::bad_alloc&) {
    return fail(chosen, core::kEnvironment, tr("not enough memory: use a coarser scene or a larger machine"),
                Json::array());
  } catch (const std::exception& error) {  // a fault of ours: nobody's input and nobody's machine
    return fail(chosen, core::kGoalNotReached, tr("trocar failed: {}", tr(error.what())), Json::array());
  }
}

}  // namespace trocar::app
