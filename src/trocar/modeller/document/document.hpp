// What a modeller has open: a scene or an organ with all files that it names, as texts. Every change is one of texts,
// so that comments and layout of what somebody wrote by hand stay, an unedited save changes nothing, and undoing is
// exact.
//
//   Document document = Document::open("scenes/cutting/scene.json");
//   document.change("soften the liver", {{file, json_set(document.text(file), "/solids/0/cell_mm", json_number(5))}});
//   document.undo();
//   document.save();
//
// Paths are weakly canonical ones. Files are read when they are first asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <trocar/scene/description/description.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::modeller {

namespace fs = std::filesystem;
using Texts = std::map<fs::path, std::string>;

/// One change as it is kept: what stood between what did not change.
struct Change {
  struct Part {
    fs::path file;
    std::size_t at = 0;                 ///< bytes before it that are the same
    std::optional<std::string> before;  ///< none: there was no such file
    std::string after;
  };
  std::string name;  ///< for people: "move uterus"
  std::vector<Part> parts;
};

class Document {
 public:
  /// @throws core::BadInput where the file cannot be read. What is wrong in it is told by description().
  static Document open(const fs::path& root);
  /// One that is on no disk yet.
  static Document fresh(const fs::path& root, std::string text);

  const fs::path& root() const { return m_root; }
  /// As edited. @throws core::BadInput where there is no such file
  const std::string& text(const fs::path& file) const;
  /// Is it one of the files read so far, or one that is on no disk yet?
  bool holds(const fs::path& file) const { return m_files.count(file) > 0; }
  /// The root and all files that it and they name and that are there, in the order in which they are met.
  std::vector<fs::path> files() const;

  /// Puts other texts in place of those that are there: one entry of the history. Nothing where none differs.
  void change(const std::string& name, const Texts& texts);
  bool undo();  ///< false: there is nothing to undo
  bool redo();
  const std::vector<Change>& history() const { return m_history; }
  std::size_t done() const { return m_done; }          ///< changes of the history that are in force
  std::uint64_t version() const { return m_version; }  ///< another one after every change

  bool is_saved(const fs::path& file) const;
  std::vector<fs::path> unsaved() const;
  /// Writes what has changed, each file at once. Nothing is written where a file is another one on the disk by now than
  /// it was when it was read, unless `over`.
  /// @throws core::BadInput with what is wrong, nothing lost
  void save(bool over = false);
  /// The root under another name from now on. In another folder everything that it names goes with it (collect.hpp).
  /// @throws core::BadInput
  void save_as(const fs::path& root);

  /// What all texts say. Faults are appended; where there are some, what is returned is what could be read.
  /// None where the root is not a scene's text that can be read at all.
  std::optional<scene::Description> description(std::vector<core::Fault>& faults) const;
  /// What stands in for files for scene::read_scene.
  scene::MemoryFiles over_disk() const;

  /// What is unsaved, for who writes it where a crash leaves it (recovery.hpp).
  Texts changed_texts() const;

 private:
  struct File {
    std::string text;
    std::optional<std::string> on_disk;  ///< when it was read or saved; none: not there
  };
  File& file(const fs::path& path) const;
  void put(const fs::path& path, std::optional<std::string> text);
  void apply(const Change& change, bool forwards);

  fs::path m_root;
  mutable std::map<fs::path, File> m_files;
  std::vector<Change> m_history;
  std::size_t m_done = 0;
  std::uint64_t m_version = 0;
};

/// As documents name files.
fs::path whole_path(const fs::path& path);

}  // namespace trocar::modeller
