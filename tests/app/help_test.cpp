// What the command line says of itself: help, manual pages, completion, the table of environment variables.
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "commands/command.hpp"
#include "commands/environment.hpp"
#include "commands/help_texts.hpp"
#include "run_program.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The options that `--help` shows: "--seed", ...
std::set<std::string> options_in(const std::string& help) {
  std::set<std::string> options;
  for (std::size_t at = help.find("\n  "); at != std::string::npos; at = help.find("\n  ", at + 1)) {
    std::size_t from = at + 3;
    while (help.compare(from, 1, "-") == 0) {
      const std::size_t to = help.find_first_of(" ,\n", from);
      if (help.compare(from, 2, "--") == 0) options.insert(help.substr(from, to - from));
      from = help.compare(to, 1, ",") == 0 ? to + 1 : to;
    }
  }
  return options;
}

std::string without_backslashes(std::string text) {
  std::erase(text, '\\');
  return text;
}

std::vector<std::string> commands() {
  const Outcome o = trocar({"--help"});
  std::vector<std::string> names;
  for (std::size_t at = o.out.find("\n  ", o.out.find("\nSubcommands:")); at != std::string::npos;) {
    const std::size_t end = o.out.find(' ', at + 3);
    names.push_back(o.out.substr(at + 3, end - at - 3));
    const std::size_t next = o.out.find('\n', at + 1);
    // a description that goes on in the next line is indented further
    at = next;
    while (at != std::string::npos && o.out.compare(at, 4, "\n   ") == 0) at = o.out.find('\n', at + 1);
    if (at == std::string::npos || o.out.compare(at, 3, "\n  ") != 0) break;
  }
  return names;
}

TEST(Help, ShowsWhatTheOptionShows) {
  EXPECT_EQ(trocar({"help"}).exit, 0);
  EXPECT_EQ(trocar({"help", "train"}).out, trocar({"train", "--help"}).out);
  EXPECT_NE(trocar({"help", "box", "simulate"}).out.find("Usage: trocar box simulate"), std::string::npos);
  const Outcome wrong = trocar({"help", "trian"});
  EXPECT_EQ(wrong.exit, 2);
  EXPECT_NE(wrong.err.find("did you mean \"train\"?"), std::string::npos) << wrong.err;
}

TEST(Help, EveryEnvironmentVariableIsInTheTable) {
  const std::string help = trocar({"--help"}).out;
  std::set<std::string> known;
  for (const EnvironmentVariable& v : environment_variables()) {
    known.insert(v.name);
    EXPECT_NE(help.find(v.name), std::string::npos) << v.name;
  }
  for (const char* root : {TROCAR_SOURCE_DIR "/src", TROCAR_SOURCE_DIR "/app"})
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(root)) {
      if (file.path().extension() != ".cpp" && file.path().extension() != ".hpp") continue;
      const std::string text = content_of(file.path());
      for (const char* call : {"getenv(\"", "environment(\""})
        for (std::size_t at = text.find(call); at != std::string::npos; at = text.find(call, at + 1)) {
          const std::size_t from = at + std::string(call).size();
          const std::string name = text.substr(from, text.find('"', from) - from);
          const bool in_table = name.rfind("TROCAR_", 0) != 0 || known.count(name) > 0;
          EXPECT_TRUE(in_table) << name << " in " << file.path();
        }
    }
}

TEST(Help, ManualPagesAndCompletionHaveEveryCommandAndOption) {
  const std::string folder = testing::TempDir() + "trocar_help_files";
  fs::remove_all(folder);
  ASSERT_EQ(trocar({"help", "--write-files", folder}).exit, 0);
  const std::string completion = content_of(folder + "/bash-completion/completions/trocar");
  const std::string program = without_backslashes(content_of(folder + "/man/man1/trocar.1"));
  for (const EnvironmentVariable& v : environment_variables()) EXPECT_NE(program.find(v.name), std::string::npos);
  const std::vector<std::string> all = commands();
  EXPECT_GE(all.size(), 19u);
  for (const std::string& command : all) {
    EXPECT_NE(program.find("trocar-" + command + " (1)"), std::string::npos) << command;
    const std::string page = without_backslashes(content_of(folder + "/man/man1/trocar-" + command + ".1"));
    EXPECT_NE(page.find(".SH EXAMPLES\n.nf\n  trocar "), std::string::npos) << command;
    for (const std::string& option : options_in(trocar({command, "--help"}).out)) {
      EXPECT_NE(page.find(option), std::string::npos) << command << ' ' << option;
      EXPECT_NE(completion.find(option), std::string::npos) << command << ' ' << option;
    }
    EXPECT_NE(completion.find("\n    " + command + ")"), std::string::npos) << command;
  }
  EXPECT_NE(content_of(folder + "/man/man1/trocar-box.1").find(".SH SIMULATE"), std::string::npos);
}

}  // namespace
}  // namespace trocar::app
