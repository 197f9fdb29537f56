// A file is chosen: places on the left (home, drives, recent folders), folders and files to click through, a line to
// type a name into, a new folder.
//
//   panel.open({.title = tr("Open"), .button = tr("Open"), .at = folder, .endings = {".json"}});
//   if (panel.is_open() && panel.draw(chosen)) open(chosen);
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace trocar::app {

struct FileWish {
  std::string title, button;         ///< what it is for; "Open", "Save"
  std::filesystem::path at;          ///< a folder, or a file whose name is proposed; empty: where the last file was
  std::vector<std::string> endings;  ///< of files that are shown; none: all
  bool saves = false;                ///< asks before it takes the name of a file that is there
};

class FilePanel {
 public:
  void open(FileWish wish);
  bool is_open() const { return m_open; }
  void close() { m_open = false; }
  /// Draws it. True: a file has been chosen.
  bool draw(std::filesystem::path& chosen);
  /// Files that were used lately, the newest first: their folders are places.
  void set_recent(const std::vector<std::filesystem::path>& files) { m_recent = files; }

 private:
  struct Place {
    std::string name;
    std::filesystem::path folder;
  };
  void go_to(const std::filesystem::path& folder);
  void find_places();
  void draw_places(std::filesystem::path& next);
  bool draw_list(std::filesystem::path& next);
  void draw_new_folder(std::filesystem::path& next);
  bool draw_filter();
  bool is_shown(const std::filesystem::path& file) const;
  std::filesystem::path named() const;

  bool m_open = false, m_all = false, m_making_folder = false, m_takes_focus = false;
  FileWish m_wish;
  std::string m_name, m_new_folder, m_trouble;
  std::filesystem::path m_folder, m_last;
  std::vector<std::filesystem::path> m_folders, m_files, m_recent;
  std::vector<Place> m_places;
};

}  // namespace trocar::app
