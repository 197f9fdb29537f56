#include "commands/help_texts.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>

#include "commands/environment.hpp"

namespace trocar::app {
namespace {

constexpr std::size_t kWidth = 100;

/// "  NAME   words of the text, in lines of at most kWidth columns"
std::string row_of(const std::string& name, const std::string& text, std::size_t indent) {
  std::string out, line = fmt::format("  {:{}}", name, indent - 2);
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    if (line.size() > indent && line.size() + 1 + (to - from) > kWidth) {
      out += line + '\n';
      line = std::string(indent, ' ');
    }
    line += (line.size() > indent ? " " : "") + text.substr(from, to - from);
    from = to + 1;
  }
  return out + line + '\n';
}

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::string program_footer() {
  std::string text = tr("Without any arguments the start screen opens.");
  text += std::string("\n") + tr("Example:") + "\n  trocar train gynaecology/sterilisation\n\n" +
          tr("Environment variables:") + "\n";
  for (const EnvironmentVariable& v : environment_variables()) text += row_of(v.name, tr(v.meaning), 24);
  text += std::string("\n") +
          tr("Exit codes: 0 done, 1 goal not reached or verification failed, 2 bad input, 3 the environment lacks "
             "something");
  return text;
}

}  // namespace trocar::app
