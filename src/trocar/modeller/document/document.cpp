#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/document/collect.hpp>
#include <trocar/modeller/document/document.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/scene/files/reader.hpp>

namespace trocar::modeller {
namespace {

std::optional<std::string> on_the_disk(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  return core::read_file(path, scene::kMaxJsonBytes);
}

Change::Part difference(const fs::path& file, const std::optional<std::string>& before, const std::string& after) {
  if (!before) return {file, 0, std::nullopt, after};
  std::size_t same = 0, tail = 0;
  const std::size_t shorter = std::min(before->size(), after.size());
  while (same < shorter && (*before)[same] == after[same]) ++same;
  while (tail < shorter - same && (*before)[before->size() - 1 - tail] == after[after.size() - 1 - tail]) ++tail;
  return {file, same, before->substr(same, before->size() - same - tail),
          after.substr(same, after.size() - same - tail)};
}

void names_in(const scene::JsonValue& value, std::vector<std::string>& out) {
  for (const scene::JsonMember& m : value.members) {
    const bool naming = names_files(m.key);
    if (naming && m.value.kind == scene::JsonValue::Kind::string) out.push_back(m.value.text);
    if (naming)
      for (const scene::JsonValue& item : m.value.items)
        if (item.kind == scene::JsonValue::Kind::string) out.push_back(item.text);
    names_in(m.value, out);
  }
  for (const scene::JsonValue& item : value.items) names_in(item, out);
}

}  // namespace

fs::path whole_path(const fs::path& path) {
  std::error_code error;
  fs::path out = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path : out;
}

Document Document::open(const fs::path& root) {
  Document document;
  document.m_root = whole_path(root);
  document.text(document.m_root);
  return document;
}

Document Document::fresh(const fs::path& root, std::string text) {
  Document document;
  document.m_root = whole_path(root);
  document.m_files[document.m_root] = {std::move(text), std::nullopt};
  return document;
}

Document::File& Document::file(const fs::path& path) const {
  const auto found = m_files.find(path);
  if (found != m_files.end()) return found->second;
  File read;
  read.on_disk = core::read_file(path, scene::kMaxJsonBytes);
  read.text = *read.on_disk;
  return m_files.emplace(path, std::move(read)).first->second;
}

const std::string& Document::text(const fs::path& path) const { return file(path).text; }

std::vector<fs::path> Document::files() const {
  std::vector<fs::path> out{m_root};
  std::set<fs::path> met{m_root};
  for (std::size_t i = 0; i < out.size() && out.size() < 256; ++i) {
    std::vector<core::Fault> ignored;
    const scene::JsonDocument read = scene::parse_json(text(out[i]), "", ignored);
    std::vector<std::string> names;
    names_in(read.root, names);
    for (const std::string& name : names) {
      const fs::path path = named_file(*this, out[i].parent_path(), name);
      std::error_code error;
      const bool there = m_files.count(path) > 0 || fs::is_regular_file(path, error);
      if (there && met.insert(path).second) out.push_back(path);
    }
  }
  return out;
}

void Document::put(const fs::path& path, std::optional<std::string> text) {
  if (!text) {
    m_files.erase(path);
    return;
  }
  const auto found = m_files.find(path);
  if (found != m_files.end())
    found->second.text = std::move(*text);
  else
    m_files[path] = {std::move(*text), on_the_disk(path)};
}

void Document::change(const std::string& name, const Texts& texts) {
  Change change{name, {}};
  for (const auto& [path, after] : texts) {
    std::error_code error;
    const bool there = m_files.count(path) > 0 || fs::is_regular_file(path, error);
    const std::optional<std::string> before = there ? std::optional(text(path)) : std::nullopt;
    if (before != after) change.parts.push_back(difference(path, before, after));
  }
  if (change.parts.empty()) return;
  m_history.resize(m_done);
  for (const auto& [path, after] : texts) put(path, after);
  m_history.push_back(std::move(change));
  ++m_done;
  ++m_version;
}

void Document::apply(const Change& change, bool forwards) {
  for (const Change::Part& part : change.parts) {
    if (!part.before) {
      put(part.file, forwards ? std::optional(part.after) : std::nullopt);
      continue;
    }
    std::string text = this->text(part.file);
    const std::string& out = forwards ? *part.before : part.after;
    text.replace(part.at, out.size(), forwards ? part.after : *part.before);
    put(part.file, std::move(text));
  }
  ++m_version;
}

bool Document::undo() {
  if (m_done == 0) return false;
  apply(m_history[--m_done], false);
  return true;
}

bool Document::redo() {
  if (m_done == m_history.size()) return false;
  apply(m_history[m_done++], true);
  return true;
}

bool Document::is_saved(const fs::path& path) const {
  const auto found = m_files.find(path);
  return found == m_files.end() || found->second.on_disk == found->second.text;
}

std::vector<fs::path> Document::unsaved() const {
  std::vector<fs::path> out;
  for (const auto& [path, file] : m_files)
    if (file.on_disk != file.text) out.push_back(path);
  return out;
}

Texts Document::changed_texts() const {
  Texts out;
  for (const fs::path& path : unsaved()) out[path] = m_files.at(path).text;
  return out;
}

void Document::save(bool over) {
  const std::vector<fs::path> changed = unsaved();
  std::vector<core::Fault> faults;
  for (const fs::path& path : changed)
    if (!over && on_the_disk(path) != m_files.at(path).on_disk)
      faults.push_back({{path.generic_string(), 0, 0},
                        "expected the file as it was read, got another one: another program has changed it meanwhile"});
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  for (const fs::path& path : changed) {
    File& file = m_files.at(path);
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    const std::string said = core::write_file(path, file.text.data(), file.text.size());
    if (said.empty())
      file.on_disk = file.text;
    else
      faults.push_back({{path.generic_string(), 0, 0},
                        tr("expected a file that can be written, got \"{}\"; nothing is lost: save again "
                           "elsewhere or when that is mended",
                           said)});
  }
  if (!faults.empty()) throw core::BadInput(std::move(faults));
}

void Document::save_as(const fs::path& root) {
  const fs::path path = whole_path(root), before = m_root;
  if (path.parent_path() != before.parent_path()) {
    const Collection all = collected(*this, path, true);
    for (const auto& [from, text] : all.texts) m_files[from] = {text, on_the_disk(from)};
    copy_files(all);
  } else {
    m_files[path] = {text(before), on_the_disk(path)};
  }
  m_root = path;
  const File old = m_files.at(before);
  if (before != path) {
    if (old.on_disk)
      m_files.at(before).text = *old.on_disk;
    else
      m_files.erase(before);
  }
  m_history.clear();
  m_done = 0;
  ++m_version;
  save(true);
}

scene::MemoryFiles Document::over_disk() const {
  scene::MemoryFiles memory;
  memory.over_disk = true;
  for (const auto& [path, file] : m_files) memory[path] = file.text;
  return memory;
}

std::optional<scene::Description> Document::description(std::vector<core::Fault>& faults) const {
  scene::MemoryFiles memory = over_disk();
  try {
    return scene::read_scene(at_home(*this, memory), &memory);
  } catch (const core::BadInput& bad) {
    for (const core::Fault& f : bad.faults()) scene::tell(faults, f);
    return std::nullopt;
  }
}

}  // namespace trocar::modeller
