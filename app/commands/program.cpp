#include "commands/program.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>

#include "commands/command.hpp"
#include "commands/environment.hpp"
#include "commands/help_texts.hpp"

namespace trocar::app {
namespace {

/// "trocar repot": the nearest command is named.
void check_command(const CLI::App& program, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    if (command->get_name() == word) return;
  for (const CLI::App* command : commands_of(program)) known.push_back(command->get_name());
  throw core::BadInput({{{"trocar", 0, 0}, scene::unknown_name("command", word, known)}});
}

/// Results that nobody received are not delivered: the disk behind a redirection may be full.
int delivered(int code) {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  fmt::print(stderr, "{}\n", tr("cannot write to standard output: {}", std::strerror(errno ? errno : EIO)));
  std::clearerr(stdout);
  return core::kEnvironment;
}

void add_commands(CLI::App& program, Chosen& chosen) {
  add_train(program, chosen);
  add_replay(program, chosen);
  add_report(program, chosen);
  add_list(program, chosen);
  add_help(program, chosen);
  add_model(program, chosen);
  add_check(program, chosen);
  add_facts(program, chosen);
  add_gallery(program, chosen);
  add_rehearse(program, chosen);
  add_join(program, chosen);
  add_trials(program, chosen);
  add_mechanism(program, chosen);
  add_room(program, chosen);
  add_compare(program, chosen);
  add_precompute(program, chosen);
  add_box(program, chosen);
  add_tracker(program, chosen);
  add_bench(program, chosen);
  add_thumbnail(program, chosen);
}

/// The descriptions of a command, its options and the commands below it, in the user's language.
void translate(CLI::App& command) {
  command.description(tr(command.get_description().c_str()));
  for (CLI::Option* option : command.get_options()) option->description(tr(option->get_description().c_str()));
  for (CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) translate(*below);
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  if (argc <= 1) {  // a person who just wants to see it
    const char* start[] = {"trocar", "train"};
    return run_program(2, start);
  }
  CLI::App program{tr("Trocar: an open real-time trainer for endoscopic surgery"), "trocar"};
  program.require_subcommand(1);
  program.set_version_flag("--version", TROCAR_VERSION);
  program.footer(program_footer);
  Chosen chosen;
  add_commands(program, chosen);
  translate(program);
  const std::string first = argv[1];
  if (!first.empty() && first[0] != '-') {
    Chosen check;
    for (int i = 2; i < argc; ++i) check.json = check.json || std::strcmp(argv[i], "--json") == 0;
    check.run = [&] {
      check_command(program, first);
      check_environment();
      return int(core::kDone);
    };
    if (const int bad = run_guarded(check); bad != core::kDone) return delivered(bad);
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return delivered(program.exit(error) == 0 ? core::kDone : core::kBadInput);
  }
  return delivered(run_guarded(chosen));
}

}  // namespace trocar::app
