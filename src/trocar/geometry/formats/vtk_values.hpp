// Values in legacy VTK files: their types, and arrays that are passed over; the kinds of cells. Used by the readers
// only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <trocar/geometry/formats/mesh_source.hpp>

namespace trocar::geometry {

/// How a value stands in binary files.
struct VtkType {
  const char* name;
  int width;  ///< [bytes]; 0: bits, eight in a byte
  bool whole, is_signed;
};
inline constexpr VtkType kVtkInt{"int", 4, true, true};

/// How many nodes a cell has, and what such cells are called.
struct VtkCell {
  int type, nodes;
  bool exactly;  ///< or at least so many
  const char* name;
  bool is_tet;
};
const VtkCell* vtk_cell(std::int64_t type);  ///< null where we know none

struct VtkValues {
  MeshSource& in;
  MeshSource::Form form = MeshSource::Form::text;  ///< of values; words between them are text

  std::string word();           ///< the next one in lower case, at most 40 letters of it
  std::string next_word();      ///< the same, and stays in front of it
  const VtkType* find_type();   ///< what the next word names; null where we do not know it
  const VtkType& type();        ///< the same, a fault where we do not know it
  const VtkType& index_type();  ///< of whole numbers

  void begin();  ///< from the line that announces values to the values
  void end() { in.set_form(MeshSource::Form::text); }
  bool binary() const { return form != MeshSource::Form::text; }
  std::size_t place();  ///< of the next value
  std::int64_t whole(const VtkType& type, const char* what);
  void pass(std::uint64_t count, const VtkType& type);
  /// Strings, each on a line or behind its length; the first 40 bytes of the first one.  [vtkDataWriter: WriteArray]
  std::string strings(std::uint64_t count);

 private:
  std::string_view packed_string();
};

}  // namespace trocar::geometry
