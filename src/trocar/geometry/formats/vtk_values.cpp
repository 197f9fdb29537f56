#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/vtk_values.hpp>

namespace trocar::geometry {
namespace {

constexpr VtkType kVtkTypes[] = {
    {"float", 4, false, true},
    {"double", 8, false, true},
    {"int", 4, true, true},
    {"unsigned_int", 4, true, false},
    {"long", 8, true, true},
    {"unsigned_long", 8, true, false},
    {"long_long", 8, true, true},
    {"vtktypeint64", 8, true, true},
    {"vtkidtype", 4, true, true},
    {"short", 2, true, true},
    {"unsigned_short", 2, true, false},
    {"char", 1, true, true},
    {"unsigned_char", 1, true, false},
    {"signed_char", 1, true, true},
};

constexpr VtkCell kCells[] = {
    {1, 1, true, "vertices", false},    {2, 0, false, "vertices", false},    {3, 2, true, "lines", false},
    {4, 0, false, "lines", false},      {5, 3, true, "triangles", false},    {6, 0, false, "triangles", false},
    {7, 0, false, "polygons", false},   {8, 4, true, "pixels", false},       {9, 4, true, "quadrangles", false},
    {10, 4, true, "tetrahedra", true},  {11, 8, true, "voxels", false},      {12, 8, true, "hexahedra", false},
    {13, 6, true, "prisms", false},     {14, 5, true, "pyramids", false},    {21, 3, true, "lines", false},
    {22, 6, true, "triangles", false},  {23, 8, true, "quadrangles", false}, {24, 10, true, "tetrahedra", true},
    {25, 20, true, "hexahedra", false}, {26, 15, true, "prisms", false},     {27, 13, true, "pyramids", false},
    {42, 0, false, "polyhedra", false}, {71, 4, false, "tetrahedra", true},
};

}  // namespace

const VtkCell* vtk_cell(std::int64_t type) {
  for (const VtkCell& cell : kCells)
    if (cell.type == type) return &cell;
  return nullptr;
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

std::string VtkValues::word() { return lower(in.word().substr(0, 40)); }
std::string VtkValues::next_word() { return lower(in.peek_word().substr(0, 40)); }

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
  if (!found) in.lose(at, tr("expected a type such as float or int, got {}", in.shown(at)));
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
  if (!in.binary()) in.skip_space();
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
    in.skip_bytes(count * std::uint64_t(type.width), "values");
  } else {
    for (std::uint64_t i = 0; i < count; ++i)
      if (in.word().empty()) in.lose(in.at(), "expected another value, got the end of the file");
  }
  end();
}

std::string read_vtk_header(VtkValues& values, const char* dataset, const char* who) {
  MeshSource& in = values.in;
  const std::string_view first = in.line();
  const std::string_view version = first.substr(first.find_last_of(' ') + 1);
  in.line();  // the title
  in.skip_space();
  std::size_t at = in.at();
  const std::string form = lower(in.line());
  if (form == "binary")
    values.form = MeshSource::Form::binary_swapped;
  else if (form != "ascii")
    in.lose(at, tr("expected ASCII or BINARY, got {}", in.shown(at)));
  in.skip_space();
  at = in.at();
  if (values.word() != "dataset") in.lose(at, tr("expected DATASET, got {}", in.shown(at)));
  in.skip_space();
  at = in.at();
  if (values.word() != lower(dataset)) in.lose(at, tr("expected {}, as {} need, got {}", dataset, who, in.shown(at)));
  in.skip_line();
  return fmt::format("VTK {}, {}", core::is_decimal(version) ? version.substr(0, 8) : "legacy",
                     values.binary() ? "binary" : "text");
}

}  // namespace trocar::geometry
