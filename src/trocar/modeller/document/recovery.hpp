// What is unsaved, where a crash leaves it: a file a document in a folder of the user's, written after changes, gone
// when all is saved.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <trocar/modeller/document/document.hpp>

namespace trocar::modeller {

class Recovery {
 public:
  /// @param folder  made where it is not there
  Recovery(fs::path folder, const fs::path& root);

  /// Writes what is unsaved, or removes the file where nothing is. Empty, or what the system says is wrong.
  std::string keep(const Document& document);
  void forget();
  const fs::path& file() const { return m_file; }

 private:
  fs::path m_file, m_root;
  std::uint64_t m_version = ~0ull;
};

/// What somebody lost: texts that were not saved when a modeller ended.
struct Lost {
  fs::path file, root;
  Texts texts;
};
/// What lies in the folder, the newest first. Files that cannot be read are left where they are.
std::vector<Lost> lost_in(const fs::path& folder);
std::optional<Lost> lost_of(const fs::path& folder, const fs::path& root);

/// The document as it was: opened where its root is on the disk, the unsaved texts as one change.
Document recovered(const Lost& lost);

}  // namespace trocar::modeller
