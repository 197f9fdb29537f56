// trocar: one program, a file a subcommand. The command line is a contract that other people's scripts call:
// exit codes 0 done, 1 goal not reached or verification failed, 2 bad input, 3 the environment lacks something.
#include <csignal>

#include "commands/program.hpp"
#include "shell/crash_note.hpp"

int main(int argc, char** argv) {
  trocar::app::leave_a_note_when_crashing();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow further is a write that fails, and told as such
  return trocar::app::run_program(argc, argv);
}
