#include <fmt/format.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/vtk_values.hpp>

namespace trocar::geometry {
namespace {

constexpr VtkType kVtkTypes[] = {
    {"float", 4, false, true},          {"double", 8, false, true},      {"int", 4, true, true},
    {"unsigned_int", 4, true, false},   {"long", 8, true, true},         {"unsigned_long", 8, true, false},
    {"long_long", 8, true, true},       {"vtktypeint64", 8, true, true}, {"vtktypeuint64", 8, true, false},
    {"vtktypeint32", 4, true, true},    {"vtkidtype", 4, true, true},    {"short", 2, true, true},
    {"unsigned_short", 2, true, false}, {"char", 1, true, true},         {"unsigned_char", 1, true, false},
    {"signed_char", 1, true, true},     {"bit", 0, true, false},
};

constexpr VtkCell kCells[] = {
    {1, 1, true, "vertices", false},    {2, 0, false, "vertices", false},    {3, 2, true, "lines", false},
    {4, 0, false, "lines", false},      {5, 3, true, "triangles", false},    {6, 0, false, "triangles", false},
    {7, 0, false, "polygons", false},   {8, 4, true, "pixels", false},       {9, 4, true, "quadrangles", false},
    {10, 4, true, "tetrahedra", true},  {11, 8, true, "voxels", false},      {12, 8, true, "hexahedra", false},
    {13, 6, true, "prisms", false},     {14, 5, true, "pyramids", false},    {21, 3, true, "lines", false},
    {22, 6, true, "triangles", false},  {23, 8, true, "quadrangles", false}, {24, 10, true, "tetrahedra", true},
    {25, 20, true, "hexahedra", false}, {26, 15, true, "prisms", false},     {27, 13, true, "pyramids", false},
    {42, 0, false, "polyhedra", false}, {69, 3, false, "triangles", false},  {70, 4, false, "quadrangles", false},
    {71, 4, false, "tetrahedra", true},
};

}  // namespace

const VtkCell* vtk_cell(std::int64_t type) {
  for (const VtkCell& cell : kCells)
    if (cell.type == type) return &cell;
  return nullptr;
}

std::string VtkValues::word() { return core::in_small_letters(in.word().substr(0, 40)); }
std::string VtkValues::next_word() { return core::in_small_letters(in.peek_word().substr(0, 40)); }

const VtkType* VtkValues::find_type() {
  const std::string name = word();
  for (const VtkType& t : kVtkTypes)
    if (name == t.name) return &t;
  return nullptr;
}

const VtkType& VtkValues::type() {
  in.skip_space();
  const std::size_t at = in.at();
  const VtkType* found = find_type();
  if (!found || found->width == 0) in.lose(at, tr("expected a type such as float or int, got {}", in.shown(at)));
  return *found;
}

const VtkType& VtkValues::index_type() {
  in.skip_space();
  const std::size_t at = in.at();
  const VtkType& found = type();
  if (!found.whole) in.lose(at, tr("expected a type of whole numbers, got {}", found.name));
  return found;
}

void VtkValues::begin() {
  in.skip_line();
  in.set_form(form);
}

std::size_t VtkValues::place() {
  in.begin_value();
  return in.at();
}

std::int64_t VtkValues::whole(const VtkType& type, const char* what) {
  std::int64_t value = 0;
  if (!in.integer(value, type.width, what)) return 0;
  if (in.binary() && !type.is_signed && value < 0 && type.width < 8) value += std::int64_t(1) << (8 * type.width);
  return value;
}

void VtkValues::pass(std::uint64_t count, const VtkType& type) {
  begin();
  if (in.binary()) {
    in.skip_bytes(type.width > 0 ? count * std::uint64_t(type.width) : (count + 7) / 8, "values");
  } else {
    for (std::uint64_t i = 0; i < count; ++i) {
      in.begin_value();
      if (in.word().empty()) in.lose(in.at(), "expected another value, got the end of the file");
    }
  }
  end();
}

std::string VtkValues::strings(std::uint64_t count) {
  begin();
  std::string first;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (in.left() == 0) in.lose(in.at(), "expected another string, got the end of the file");
    const std::string_view one = in.binary() ? packed_string() : in.line();
    if (i == 0) first = std::string(one.substr(0, 40));
  }
  end();
  return first;
}

std::string_view VtkValues::packed_string() {
  const auto byte = [this](std::size_t k) { return std::uint64_t(static_cast<unsigned char>(in.all()[in.at() + k])); };
  constexpr std::size_t kBytes[] = {8, 4, 2, 1};  // of the length, by its two highest bits
  const std::size_t at = in.at(), bytes = kBytes[byte(0) >> 6];
  if (bytes > in.left()) in.lose(at, "expected the length of a string, got the end of the file");
  std::uint64_t length = byte(0) & 0x3f;
  for (std::size_t k = 1; k < bytes; ++k) length = length << 8 | byte(k);
  in.skip_bytes(bytes, "a length");
  in.skip_bytes(length, "a string");
  return in.all().substr(at + bytes, std::size_t(length));
}

}  // namespace trocar::geometry
