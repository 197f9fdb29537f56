// Materials: the appearance of a surface and the anatomy drawn around it, one a file, named like the file
// (scenes/looks/liver.json is the look "liver"). A look may inherit another one of its folder and says what differs.
//
//   std::vector<core::Fault> faults;
//   const MaterialFolders materials({"scenes/looks"}, faults);
//   model.looks = materials.library();
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <trocar/scene/json/shape.hpp>
#include <trocar/sim/model/looks.hpp>

namespace trocar::scene {

class MaterialFolders {
 public:
  /// Reads all looks of these folders; of two with one name the first folder's counts. What is wrong is appended to the
  /// faults. With `memory` files are looked up there.
  MaterialFolders(const std::vector<std::filesystem::path>& folders, std::vector<core::Fault>& faults,
                  const MemoryFiles* memory = nullptr);

  bool empty() const { return m_files.empty(); }
  std::vector<std::string> names() const;  ///< sorted
  std::shared_ptr<const sim::MaterialLibrary> library() const { return m_library; }

 private:
  using Open = std::vector<std::string>;  ///< names of looks that are being read, one inheriting the next
  const sim::Look& look(const std::string& name, Open& open);
  void inherit(const JsonObject& o, sim::Look& look, Open& open);

  std::map<std::string, std::filesystem::path> m_files;
  std::map<std::string, sim::Look> m_read;
  std::vector<core::Fault>& m_faults;
  const MemoryFiles* m_memory;
  std::shared_ptr<const sim::MaterialLibrary> m_library;
};

const Shape& look_shape();

}  // namespace trocar::scene
