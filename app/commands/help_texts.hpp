// What the command line says of itself: the end of `trocar --help`, manual pages and shell completion, all made from
// the commands and options that CLI11 holds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace trocar::app {

/// The commands below `app`, in their order, without hidden ones.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// Example, environment variables, exit codes.
std::string program_footer();

/// Pages for man(1), and a script for bash.
struct HelpFile {
  std::string name;  ///< "trocar-train.1"
  std::string text;
};
/// trocar.1 and a page for each command: trocar-train.1, ...
std::vector<HelpFile> manual_pages(const CLI::App& program);
/// The script `trocar`, for a folder bash-completion/completions.
HelpFile bash_completion(const CLI::App& program);

}  // namespace trocar::app
