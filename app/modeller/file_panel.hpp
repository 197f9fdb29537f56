// A file is chosen: folders and files to click through, and a line to type a name into.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace trocar::app {

class FilePanel {
 public:
  /// @param title  what the file is for; @param button  "Open", "Save"
  void open(std::string title, std::string button, const std::filesystem::path& at, std::vector<std::string> endings);
  bool is_open() const { return m_open; }
  void close() { m_open = false; }
  /// Draws it. True: a file has been chosen.
  bool draw(std::filesystem::path& chosen);

 private:
  void go_to(const std::filesystem::path& folder);

  bool m_open = false;
  std::string m_title, m_button, m_name;
  std::vector<std::string> m_endings;
  std::filesystem::path m_folder;
  std::vector<std::filesystem::path> m_folders, m_files;
};

}  // namespace trocar::app
