// trocar help: the help of a command; manual pages and shell completion as files.
#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>

#include "commands/command.hpp"
#include "commands/help_texts.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

struct HelpChoice {
  std::vector<std::string> words;
  std::string folder;
};

std::string help_of(const CLI::App& program, const std::vector<std::string>& words) {
  const CLI::App* app = &program;
  std::string before;
  for (const std::string& word : words) {
    std::vector<std::string> known;
    const CLI::App* next = nullptr;
    for (const CLI::App* c : commands_of(*app)) {
      known.push_back(c->get_name());
      if (c->get_name() == word) next = c;
    }
    if (!next) throw core::BadInput({{{"help", 0, 0}, scene::unknown_name("command", word, known)}});
    before += (before.empty() ? "" : " ") + app->get_name();
    app = next;
  }
  return app->get_formatter()->make_help(app, (before.empty() ? "" : before + " ") + app->get_name(),
                                         CLI::AppFormatMode::Normal);
}

void write_help_file(const fs::path& folder, const HelpFile& file) {
  attempt::make_folder(folder);
  std::ofstream out(folder / file.name, std::ios::binary);
  out << file.text;
  if (!out.flush())
    throw core::EnvironmentLacks(
        tr("cannot write {}: {}", (folder / file.name).string(), std::strerror(errno ? errno : ENOSPC)));
}

/// As they are installed below share/.
void write_help_files(const CLI::App& program, const fs::path& share) {
  for (const HelpFile& page : manual_pages(program)) write_help_file(share / "man" / "man1", page);
  write_help_file(share / "bash-completion" / "completions", bash_completion(program));
}

}  // namespace

void add_help(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<HelpChoice>();
  CLI::App* c = add_command(program, chosen, "help", tr("Show the help of a command"),
                            "trocar help train\n  trocar help box simulate");
  c->add_option("command", o->words, tr("a command, and the command below it; without one: all commands"));
  c->add_option(
      "--write-files", o->folder,
      tr("write manual pages and bash completion to man/man1 and bash-completion/completions in this folder"));
  c->callback([o, &program, &chosen] {
    chosen.run = [o, &program, &chosen] {
      if (!o->folder.empty()) {
        write_help_files(program, o->folder);
        if (chosen.json) print({{"folder", o->folder}});
        return int(core::kDone);
      }
      const std::string text = help_of(program, o->words);
      if (chosen.json)
        print({{"help", text}});
      else
        fmt::print("{}", text);
      return int(core::kDone);
    };
  });
}

}  // namespace trocar::app
