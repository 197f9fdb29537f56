// The whole command line, callable: main() does no more than this, and tests call it, too.
#pragma once

namespace trocar::app {

/// Parses and runs; returns the exit code (core::ExitCode).
int run_program(int argc, const char* const* argv);

}  // namespace trocar::app
