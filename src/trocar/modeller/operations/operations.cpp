#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {

const std::vector<Operation>& operations() {
  static const std::vector<Operation> all = [] {
    std::vector<Operation> list;
    for (const auto& of_kind : {body_operations, key_operations, transform_operations, point_operations,
                                vessel_operations, primitive_operations, spline_operations, file_operations,
                                link_operations, paint_operations, place_operations})
      for (Operation& one : of_kind()) list.push_back(std::move(one));
    return list;
  }();
  return all;
}

const Operation* find_operation(std::string_view name) {
  for (const Operation& one : operations())
    if (one.parameters.name == name) return &one;
  return nullptr;
}

std::string Operation::title(const scene::JsonObject& o) const {
  std::string of;
  for (const char* key : {"of", "name", "vessel"})
    if (of.empty() && o.has(key)) {
      of = o.text(key);
      for (const std::string& each : o.texts(key)) of += (of.empty() ? "" : ", ") + each;
    }
  std::string said = parameters.name;
  for (char& c : said)
    if (c == '_') c = ' ';
  return of.empty() ? said : said + " " + of;
}

namespace {

/// Files of the installed folder `scenes` belong to all documents; those outside the document's own folder and its
/// libraries its scene could not be read from.
void refuse_elsewhere(const Document& document, const Texts& texts) {
  const scene::Library library(document.root());
  for (const auto& [file, text] : texts)
    if (!library.holds(file)) throw core::BadInput({{{"", 0, 0}, library.refusal(file.generic_string())}});
  if (scene::name_in_installed_scenes(document.root())) return;
  for (const auto& [file, text] : texts)
    if (scene::name_in_installed_scenes(file))
      throw core::BadInput({{{"", 0, 0},
                             tr("This belongs to {}, which all documents share. It cannot be changed here.",
                                file.filename().string())}});
}

}  // namespace

void commit(Document& document, const std::string& title, const Draft& draft) {
  refuse_elsewhere(document, draft.texts());
  document.change(title, draft.texts());
}

std::string apply(const Operation& operation, const scene::JsonValue& parameters, const std::string& file,
                  Document& document) {
  std::vector<core::Fault> faults;
  const scene::JsonObject o(parameters, operation.parameters, file, faults);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  Draft draft(document);
  try {
    operation.apply(o, draft);
  } catch (const std::invalid_argument& unreadable) {
    o.fault(o.at(), unreadable.what());
  }
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  commit(document, operation.title(o), draft);
  return draft.said();
}

const std::string& Draft::text(const fs::path& file) const {
  const auto found = m_texts.find(file);
  return found == m_texts.end() ? m_document.text(file) : found->second;
}

bool Draft::has(const fs::path& file) const {
  try {
    text(file);
    return true;
  } catch (const core::BadInput&) {
    return false;
  }
}

scene::JsonValue Draft::value(const fs::path& file, const std::string& path) const {
  std::vector<core::Fault> ignored;
  const scene::JsonDocument read = scene::parse_json(text(file), "", ignored);
  const scene::JsonValue* value = scene::json_at(read.root, path);
  return value ? *value : scene::JsonValue{};
}

void Draft::set(const fs::path& file, const std::string& path, const scene::JsonValue& value) {
  put(file, scene::json_set(text(file), path, value));
}
void Draft::set_all(const fs::path& file, std::vector<std::pair<std::string, scene::JsonValue>> values) {
  put(file, scene::json_set_all(text(file), std::move(values)));
}
void Draft::insert(const fs::path& file, const std::string& array, std::size_t item, const scene::JsonValue& value) {
  put(file, scene::json_insert(text(file), array, item, value));
}
void Draft::remove(const fs::path& file, const std::string& path) { put(file, scene::json_remove(text(file), path)); }

}  // namespace trocar::modeller
