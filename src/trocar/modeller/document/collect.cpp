#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/modeller/document/collect.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/json_text.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;

constexpr std::uint64_t kMostBytes = std::uint64_t(1) << 30;  // of a file that is copied

bool below(const fs::path& file, const fs::path& folder) {
  const auto [in_folder, in_file] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return in_folder == folder.end() && in_file != file.end();
}

/// A key whose value names a file that is no text of the document: "file" of a surface, a mechanism by its path.
bool names_data(const scene::JsonMember& m) {
  if (m.value.kind != JsonValue::Kind::string) return false;
  return m.key == "file" || (m.key == "mechanism" && m.value.text.find_first_of("/.") != std::string::npos);
}

class Collector {
 public:
  Collector(const Document& document, const fs::path& root, bool tree_stays)
      : m_document(document), m_folder(whole_path(root).parent_path()), m_tree(root), m_tree_stays(tree_stays) {
    m_out.root = whole_path(root);
    m_placed[document.root()] = m_out.root;
    m_taken.insert(m_out.root);
  }

  Collection all() {
    m_texts.push_back(m_document.root());
    for (std::size_t i = 0; i < m_texts.size(); ++i) take_text(fs::path(m_texts[i]));
    return std::move(m_out);
  }

 private:
  using Names = std::vector<std::pair<std::string, JsonValue>>;

  void take_text(const fs::path& file) {
    std::vector<core::Fault> ignored;
    const scene::JsonDocument read = scene::parse_json(m_document.text(file), "", ignored);
    Names names;
    names_in(read.root, "", file.parent_path(), m_placed.at(file).parent_path(), names);
    m_out.texts[m_placed.at(file)] = scene::json_set_all(m_document.text(file), std::move(names));
  }

  void names_in(const JsonValue& value, const std::string& path, const fs::path& from, const fs::path& to, Names& out) {
    for (const scene::JsonMember& m : value.members) {
      const std::string at = scene::json_path(path, m.key);
      if (names_files(m.key)) {
        name(m.value, at, from, to, true, out);
        for (std::size_t i = 0; i < m.value.items.size(); ++i)
          name(m.value.items[i], scene::json_path(at, i), from, to, true, out);
      } else if (names_data(m)) {
        name(m.value, at, from, to, false, out);
      }
      names_in(m.value, at, from, to, out);
    }
    for (std::size_t i = 0; i < value.items.size(); ++i)
      names_in(value.items[i], scene::json_path(path, i), from, to, out);
  }

  void name(const JsonValue& value, const std::string& path, const fs::path& from, const fs::path& to, bool text,
            Names& out) {
    if (value.kind != JsonValue::Kind::string) return;
    const fs::path file = named_file(m_document, from, value.text);
    std::error_code error;
    if (!m_document.holds(file) && !fs::is_regular_file(file, error)) {
      m_out.missing.push_back(value.text);
      return;
    }
    const std::string named = name_of(file, to, text);
    if (named != value.text) out.emplace_back(path, scene::json_text(named));
  }

  std::string name_of(const fs::path& file, const fs::path& to, bool text) {
    const bool stays = m_tree_stays ? m_tree.holds(file) : below(file, m_folder);
    const std::optional<std::string> installed = scene::name_in_installed_scenes(file);
    if (installed && !(m_tree_stays && scene::name_in_installed_scenes(m_out.root))) return *installed;
    if (m_placed.count(file) == 0) {
      m_placed[file] = stays ? file : free_place(file);
      if (text && !stays) m_texts.push_back(file);
      if (!text && !stays) m_out.copies.emplace_back(file, m_placed[file]);
    }
    return m_placed[file].lexically_relative(to).generic_string();
  }

  /// Beside the root, under a name that nothing else has there.
  fs::path free_place(const fs::path& file) {
    std::error_code error;
    for (int i = 1;; ++i) {
      const std::string number = i == 1 ? "" : fmt::format("-{}", i);
      const fs::path place = m_folder / (file.stem().string() + number + file.extension().string());
      if (!fs::exists(place, error) && m_taken.insert(place).second) return place;
    }
  }

  const Document& m_document;
  fs::path m_folder;
  scene::Library m_tree;
  bool m_tree_stays;
  Collection m_out;
  std::vector<fs::path> m_texts;
  std::map<fs::path, fs::path> m_placed;  ///< where each file goes
  std::set<fs::path> m_taken;
};

}  // namespace

Collection collected(const Document& document, const fs::path& root, bool tree_stays) {
  return Collector(document, root, tree_stays).all();
}

void copy_files(const Collection& collection) {
  for (const auto& [from, to] : collection.copies) core::put_file(to, core::read_file(from, kMostBytes));
}

void write_collection(const Collection& collection) {
  copy_files(collection);
  for (const auto& [path, text] : collection.texts)
    if (path != collection.root) core::put_file(path, text);
  core::put_file(collection.root, collection.texts.at(collection.root));
}

fs::path write_scene_for_trainer(const Document& document, const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  const scene::MemoryFiles memory = document.over_disk();
  const bool alone = scene::kind_of_file(document.root(), &memory) == scene::FileKind::organ;
  const fs::path scene = whole_path(folder / "scene.json"), organ = whole_path(folder / "organ.json");
  write_collection(collected(document, alone ? organ : scene));
  if (alone) core::put_file(scene, text_of_place_with(organ.filename().string(), document.root().stem().string()));
  return scene;
}

}  // namespace trocar::modeller
