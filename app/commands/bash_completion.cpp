// Completion for bash: commands, options, and names that `trocar list` knows; elsewhere files.
#include <fmt/format.h>

#include "commands/help_texts.hpp"

namespace trocar::app {
namespace {

/// What the first argument of a command names, as `trocar list` calls it.
constexpr std::pair<const char*, const char*> kNamed[] = {
    {"train", "exercises scenes"},   {"facts", "exercises scenes"},
    {"rehearse", "exercises"},       {"precompute", "exercises scenes"},
    {"compare", "exercises scenes"}, {"bench", "exercises scenes"},
    {"mechanism", "mechanisms"},     {"room", "rooms"}};

std::string words_of(const CLI::App& app) {
  std::string words;
  for (const CLI::App* part : commands_of(app)) words += part->get_name() + " ";
  for (const CLI::Option* o : app.get_options([](const CLI::Option* each) { return !each->get_group().empty(); }))
    for (const std::string& name : o->get_lnames()) words += "--" + name + " ";
  if (!words.empty()) words.pop_back();
  return words;
}

}  // namespace

HelpFile bash_completion(const CLI::App& program) {
  std::string text =
      "# bash completion for trocar; made by `trocar help --write-files`\n"
      "_trocar() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} words= kinds= kind\n"
      "  case \"${COMP_WORDS[1]}\" in\n";
  for (const CLI::App* c : commands_of(program)) {
    std::string parts;
    for (const CLI::App* part : commands_of(*c))
      parts += fmt::format("        {}) words=\"{}\" ;;\n", part->get_name(), words_of(*part));
    text += fmt::format("    {})\n      words=\"{}\"\n", c->get_name(), words_of(*c));
    if (!parts.empty())
      text += "      [ \"$COMP_CWORD\" -gt 2 ] && case \"${COMP_WORDS[2]}\" in\n" + parts + "      esac\n";
    for (const auto& [command, kinds] : kNamed)
      if (c->get_name() == command) text += fmt::format("      kinds=\"{}\"\n", kinds);
    text += "      ;;\n";
  }
  text += fmt::format("  esac\n  [ \"$COMP_CWORD\" -eq 1 ] && words=\"{}\" kinds=\n", words_of(program));
  text +=
      "  if [ \"$COMP_CWORD\" -eq 2 ]; then\n"
      "    for kind in $kinds; do words+=\" $(trocar list \"$kind\" --names 2>/dev/null)\"; done\n"
      "  fi\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
      "}\n"
      "complete -o default -F _trocar trocar\n";
  return {"trocar", text};
}

}  // namespace trocar::app
