// trocar: one program, a file a subcommand. The command line is a contract that other people's scripts call:
// exit codes 0 done, 1 goal not reached or verification failed, 2 bad input, 3 the environment lacks something.
#include <trocar/core/error.hpp>

#include "command.hpp"

int main(int argc, char** argv) {
  using namespace trocar;
  CLI::App program{"Trocar: an open real-time trainer for endoscopic surgery", "trocar"};
  program.require_subcommand(1);
  program.set_version_flag("--version", TROCAR_VERSION);
  program.footer(
      "Example:\n  trocar train gynaecology/sterilisation\nExit codes: 0 done, 1 goal not reached or "
      "verification failed, 2 bad input, 3 the environment lacks something");
  app::Chosen chosen;
  app::add_train(program, chosen);
  app::add_replay(program, chosen);
  app::add_check(program, chosen);
  app::add_gallery(program, chosen);
  app::add_list(program, chosen);
  app::add_bench(program, chosen);
  app::add_report(program, chosen);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? core::kDone : core::kBadInput;
  }
  return app::run_guarded(chosen);
}
