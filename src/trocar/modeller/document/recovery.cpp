#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/modeller/document/recovery.hpp>
#include <trocar/scene/json/json_text.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;

std::string name_for(const fs::path& root) {
  const std::string text = root.generic_string();
  return fmt::format("{}-{:016x}.json", root.stem().string(), core::hash_bytes(text.data(), text.size()));
}

std::optional<Lost> read(const fs::path& file) {
  try {
    std::vector<core::Fault> faults;
    const scene::JsonDocument read = scene::parse_json(core::read_file(file, scene::kMaxJsonBytes), "", faults);
    const scene::JsonMember *root = read.root.find("root"), *texts = read.root.find("texts");
    if (!faults.empty() || !root || !texts) return std::nullopt;
    Lost lost{file, root->value.text, {}};
    for (const JsonValue& item : texts->value.items)
      if (const scene::JsonMember* path = item.find("file"), *text = item.find("text"); path && text)
        lost.texts[path->value.text] = text->value.text;
    return lost;
  } catch (const core::BadInput&) {
    return std::nullopt;
  }
}

}  // namespace

Recovery::Recovery(fs::path folder, const fs::path& root) : m_file(folder / name_for(root)), m_root(root) {
  std::error_code ignored;
  fs::create_directories(folder, ignored);
}

std::string Recovery::keep(const Document& document) {
  if (document.version() == m_version) return {};
  const Texts texts = document.changed_texts();
  if (texts.empty()) {
    forget();
    m_version = document.version();
    return {};
  }
  std::vector<JsonValue> items;
  for (const auto& [path, text] : texts) {
    JsonValue item = scene::json_object();
    scene::put(item, "file", scene::json_text(path.generic_string()));
    scene::put(item, "text", scene::json_text(text));
    items.push_back(std::move(item));
  }
  JsonValue all = scene::json_object();
  scene::put(all, "root", scene::json_text(m_root.generic_string()));
  scene::put(all, "texts", scene::json_array(std::move(items)));
  const std::string text = scene::to_text(all);
  const std::string said = core::write_file(m_file, text.data(), text.size(), 0600);
  if (said.empty()) m_version = document.version();
  return said;
}

void Recovery::forget() {
  std::error_code ignored;
  fs::remove(m_file, ignored);
}

std::vector<Lost> lost_in(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, Lost>> found;
  std::error_code error;
  fs::directory_iterator at(folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error))
    if (at->path().extension() == ".json")
      if (std::optional<Lost> lost = read(at->path())) found.emplace_back(at->last_write_time(), std::move(*lost));
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Lost> out;
  for (auto& [time, lost] : found) out.push_back(std::move(lost));
  return out;
}

std::optional<Lost> lost_of(const fs::path& folder, const fs::path& root) {
  const fs::path file = folder / name_for(root);
  std::error_code error;
  return fs::is_regular_file(file, error) ? read(file) : std::nullopt;
}

Document recovered(const Lost& lost) {
  std::error_code error;
  const auto root = lost.texts.find(lost.root);
  Document document = fs::is_regular_file(lost.root, error) || root == lost.texts.end()
                          ? Document::open(lost.root)
                          : Document::fresh(lost.root, root->second);
  document.change("what was not saved", lost.texts);
  return document;
}

}  // namespace trocar::modeller
