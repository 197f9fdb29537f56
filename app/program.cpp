#include "program.hpp"

#include <trocar/core/error.hpp>

#include "command.hpp"

namespace trocar::app {

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
  add_bench(program, chosen);
  add_report(program, chosen);
  add_trials(program, chosen);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? core::kDone : core::kBadInput;
  }
  return run_guarded(chosen);
}

}  // namespace trocar::app
