// The import dialogue: what a file holds is read beside the window; then its unit is asked for with the size that each
// makes, its tissue and material are chosen from lists, and it is placed in the endoscope's view or where the file has
// it.
#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include <trocar/modeller/materials/materials.hpp>
#include <trocar/modeller/operations/import_preview.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::app {

class ImportPanel {
 public:
  /// @param name  that the body will have: free in the document
  void open(const std::filesystem::path& file, std::string name, std::vector<modeller::TissueChoice> tissues);
  bool is_open() const { return m_open; }
  void close() { m_open = false; }
  /// Shown in the dialogue: why the last try did not succeed.
  void refuse(const std::string& why) { m_trouble = why; }

  /// Draws it. True: Import was pressed, and step() is what to do.
  bool draw();
  /// @param in_view_mm  where the middle of a body of such a size goes to be in view; it is asked where that is wanted
  template <class Place>
  scene::JsonValue step(Place&& in_view_mm) const {
    const Vec3d size = size_mm();
    return made_step(m_in_view ? std::optional<Vec3d>(in_view_mm(size)) : std::nullopt);
  }
  bool attaches() const { return m_attach; }
  const std::string& name() const { return m_name; }

 private:
  void take_what_was_read();
  void draw_units();
  void draw_notes();
  void draw_parts();
  void draw_fields();
  void draw_details();
  Vec3d size_mm() const;
  Vec3d middle_mm() const;
  double volume_mL(double unit) const;
  scene::JsonValue made_step(std::optional<Vec3d> centre_mm) const;

  bool m_open = false, m_in_view = true, m_attach = true, m_material_chosen = false, m_as_surface = false;
  std::filesystem::path m_file;
  std::string m_name, m_tissue, m_material, m_trouble;
  std::vector<modeller::TissueChoice> m_tissues;
  std::future<modeller::ImportPreview> m_reading;
  std::optional<modeller::ImportPreview> m_preview;
  double m_unit = 1e-3;  ///< [m]
  double m_cell_mm = 0;  ///< 0: such that about 700 cells fill it
  double m_deviation_mm = 0.05;
  int m_part = -1;  ///< -1: all of them
};

}  // namespace trocar::app
