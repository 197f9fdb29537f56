// What the subcommands share: how they join the program, and how what happens becomes output and an exit code.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include <trocar/core/json.hpp>

namespace trocar::app {

/// What the chosen subcommand does; its result is the exit code.
struct Chosen {
  std::function<int()> run;
  bool json = false;  ///< one JSON object on standard output, whatever happens
};

/// Adds a subcommand with an example under its help, and --json.
CLI::App* add_command(CLI::App& program, Chosen& chosen, const std::string& name, const std::string& what,
                      const std::string& example);

/// Prints one JSON object and a newline on standard output.
void print(const Json& object);

/// Runs and maps exceptions: core::BadInput -> 2 with every fault, core::EnvironmentLacks -> 3 with its remedy.
int run_guarded(const Chosen& chosen);

void add_train(CLI::App& program, Chosen& chosen);
void add_replay(CLI::App& program, Chosen& chosen);
void add_check(CLI::App& program, Chosen& chosen);
void add_list(CLI::App& program, Chosen& chosen);
void add_help(CLI::App& program, Chosen& chosen);
void add_facts(CLI::App& program, Chosen& chosen);
void add_bench(CLI::App& program, Chosen& chosen);
void add_gallery(CLI::App& program, Chosen& chosen);
void add_report(CLI::App& program, Chosen& chosen);
void add_trials(CLI::App& program, Chosen& chosen);
void add_precompute(CLI::App& program, Chosen& chosen);
void add_compare(CLI::App& program, Chosen& chosen);
void add_rehearse(CLI::App& program, Chosen& chosen);
void add_join(CLI::App& program, Chosen& chosen);
void add_model(CLI::App& program, Chosen& chosen);
void add_mechanism(CLI::App& program, Chosen& chosen);
void add_room(CLI::App& program, Chosen& chosen);
void add_box(CLI::App& program, Chosen& chosen);
void add_tracker(CLI::App& program, Chosen& chosen);
void add_thumbnail(CLI::App& program, Chosen& chosen);  ///< for the start screen

}  // namespace trocar::app
