// What a legacy VTK file says about points and cells: arrays of many kinds, of which the regions of cells are kept and
// the others passed over; the patient's axes that 3D Slicer names. Used by vtk_dataset.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/geometry/formats/patient_axes.hpp>
#include <trocar/geometry/formats/vtk_values.hpp>

namespace trocar::geometry {

class VtkData {
 public:
  explicit VtkData(VtkValues& values) : m_values(values) {}

  /// After POINT_DATA or CELL_DATA, of which there must be `wanted`.
  void begin(bool of_cells, std::size_t wanted, std::size_t at);
  /// A kind of array, such as scalars. One that we do not know ends the reading: the mesh is complete by then.
  void attribute(const std::string& kind);
  /// FIELD name arrays, then for each: name components tuples type, values
  void field();
  /// Up to an empty line.
  void metadata();

  const std::vector<int>& regions() const { return m_regions; }  ///< of all cells, or none
  const std::string& stopped() const { return m_stopped; }       ///< the word at which reading ended, or nothing
  std::size_t stopped_at() const { return m_stopped_at; }
  PatientAxes axes() const { return m_axes; }  ///< that a field called SPACE names

 private:
  /// SCALARS name type [components], LOOKUP_TABLE name, values
  void scalars();
  void array(const std::string& name, const VtkType& type, std::uint64_t components, std::size_t tuples);
  void stop(const std::string& word) {
    m_stopped = word.empty() ? "?" : word;
    m_stopped_at = m_values.in.at();
  }

  VtkValues& m_values;
  bool m_of_cells = false;   ///< what comes is data of cells ...
  std::size_t m_tuples = 0;  ///< ... or points, so many
  std::vector<int> m_regions;
  std::string m_stopped;
  std::size_t m_stopped_at = 0;
  PatientAxes m_axes = PatientAxes::none;
};

}  // namespace trocar::geometry
