// What can be done to a document, an operation a name: what a menu offers, what a script says, what a drag ends in. An
// operation's parameters are a table like those of scene files, so that whoever writes a script is told of every fault
// with its place, and a window can ask for them without knowing the operation.
//
//   const Operation& move = operation("move");
//   Draft draft(document);
//   move.apply(parameters, draft);
//   document.change("move uterus", draft.texts());
//
// Another operation is a file with a table and a function, and a line in operations.cpp.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/modeller/document/outline.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::modeller {

/// Texts on their way to be a change of the document.
class Draft {
 public:
  explicit Draft(const Document& document) : m_document(document) {}

  const Document& document() const { return m_document; }
  /// As changed so far.
  const std::string& text(const fs::path& file) const;
  bool has(const fs::path& file) const;
  void put(const fs::path& file, std::string text) { m_texts[file] = std::move(text); }
  /// Something worth telling about what was done: a fit's residual.
  void say(const std::string& words) { m_said += (m_said.empty() ? "" : "; ") + words; }
  void say(const std::vector<std::string>& all) {
    for (const std::string& words : all) say(words);
  }
  const std::string& said() const { return m_said; }
  const Texts& texts() const { return m_texts; }

  Thing thing(std::string_view name) const { return thing_named(m_document, name); }
  scene::JsonValue value(const fs::path& file, const std::string& path) const;  ///< null-kind where there is none
  void set(const fs::path& file, const std::string& path, const scene::JsonValue& value);
  void set_all(const fs::path& file, std::vector<std::pair<std::string, scene::JsonValue>> values);
  void insert(const fs::path& file, const std::string& array, std::size_t item, const scene::JsonValue& value);
  void remove(const fs::path& file, const std::string& path);

 private:
  const Document& m_document;
  Texts m_texts;
  std::string m_said;
};

struct Operation {
  scene::Shape parameters;  ///< its name is the operation's, its meaning what it does
  /// Faults of parameters are told through `o`; anything else that cannot be done throws core::BadInput.
  std::function<void(const scene::JsonObject& o, Draft& draft)> apply;
  /// What the history calls it, e.g. "move uterus".
  std::string title(const scene::JsonObject& o) const;
};

/// The draft's texts become one entry of the document's history. @throws core::BadInput for a file that a document
/// cannot name, as it lies outside its folder, or that all documents share
void commit(Document& document, const std::string& title, const Draft& draft);

const std::vector<Operation>& operations();
const Operation* find_operation(std::string_view name);  ///< null where there is none

/// Does what `parameters` say, as one entry of the history. `file` is named in faults. Nothing has changed where it
/// throws.
/// @return what is worth telling about it; mostly nothing  @throws core::BadInput
std::string apply(const Operation& operation, const scene::JsonValue& parameters, const std::string& file,
                  Document& document);

}  // namespace trocar::modeller
