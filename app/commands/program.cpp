#include "commands/program.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/shape.hpp>

#include "commands/command.hpp"

namespace trocar::app {
namespace {

constexpr int kMostThreads = 64;

/// "trocar repot": the nearest command is named.
void check_command(const CLI::App& program, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(command->get_name());
  for (const std::string& name : known)
    if (name == word) return;
  throw core::BadInput({{{"trocar", 0, 0}, scene::unknown_name("command", word, known)}});
}

/// A variable that is set and wrong would otherwise be left aside without a word.
void check_environment() {
  const char* text = std::getenv("TROCAR_THREADS");
  if (!text) return;
  char* end = nullptr;
  const long threads = std::strtol(text, &end, 10);
  if (end == text || *end != 0 || threads < 1 || threads > kMostThreads)
    throw core::BadInput({{{"TROCAR_THREADS", 0, 0},
                           fmt::format("expected a whole number from 1 to {}, got '{}'", kMostThreads, text)}});
}

/// Results that nobody received are not delivered: the disk behind a redirection may be full.
int delivered(int code) {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  fmt::print(stderr, "cannot write to standard output: {}\n", std::strerror(errno ? errno : EIO));
  std::clearerr(stdout);
  return core::kEnvironment;
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  if (argc <= 1) {  // a person who just wants to see it
    const char* start[] = {"trocar", "train"};
    return run_program(2, start);
  }
  CLI::App program{"Trocar: an open real-time trainer for endoscopic surgery", "trocar"};
  program.require_subcommand(1);
  program.set_version_flag("--version", TROCAR_VERSION);
  program.footer(
      "Without any arguments: the start screen.\nExample:\n  trocar train gynaecology/sterilisation\n"
      "Exit codes: 0 done, 1 goal not reached or verification failed, 2 bad input, 3 the environment lacks something");
  Chosen chosen;
  add_train(program, chosen);
  add_replay(program, chosen);
  add_check(program, chosen);
  add_gallery(program, chosen);
  add_list(program, chosen);
  add_facts(program, chosen);
  add_bench(program, chosen);
  add_report(program, chosen);
  add_trials(program, chosen);
  add_precompute(program, chosen);
  add_rehearse(program, chosen);
  add_join(program, chosen);
  add_model(program, chosen);
  add_mechanism(program, chosen);
  add_room(program, chosen);
  add_compare(program, chosen);
  add_box(program, chosen);
  add_tracker(program, chosen);
  add_thumbnail(program, chosen);
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
