// Lists of points in legacy VTK files: cells, polygons, strips. In files before 5.0 each list has its length in front;
// from 5.0 on all lengths stand apart, as OFFSETS, and the points follow as CONNECTIVITY. Used by the readers only.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/geometry/formats/vtk_values.hpp>

namespace trocar::geometry {

class VtkLists {
 public:
  /// @param things  in the plural, as faults name them: "cells"
  VtkLists(VtkValues& values, const char* things) : m_values(values), m_things(things) {}

  /// After the word that announces them. Numbers of points are not checked.
  void read();

  bool empty() const { return m_start.empty(); }
  std::size_t count() const { return m_start.empty() ? 0 : m_start.size() - 1; }
  std::int64_t length(std::size_t list) const { return m_start[list + 1] - m_start[list]; }
  std::int64_t point(std::size_t list, std::int64_t k) const { return m_points[std::size_t(m_start[list] + k)]; }
  /// Where in the file that stands; the end of the file for the end of the last list.
  std::size_t place(std::size_t list, std::int64_t k = 0) const;

 private:
  VtkValues& m_values;
  const char* m_things;
  std::vector<std::int64_t> m_start, m_points;  ///< start: one more than lists
  std::vector<std::uint32_t> m_at;              ///< of m_points, their place in the file

  /// @param size  of all numbers, those of lengths included
  void lengths_in_front(std::size_t count, std::size_t size);
  void lengths_apart(std::size_t offsets, std::size_t size);
  void connectivity(std::size_t size);
  void point(const VtkType& type);
};

}  // namespace trocar::geometry
