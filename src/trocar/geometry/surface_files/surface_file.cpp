// Which format a file has, and what readers of surfaces share.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <trocar/core/files.hpp>
#include <trocar/core/foreign/foreign_file.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/polygons.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>

namespace trocar::geometry {
namespace {

constexpr const char* kSurfaceFormats = "a surface in OBJ, STL, PLY, glTF 2.0 or legacy VTK";

/// Do the first words of lines look like OBJ?
bool looks_like_obj(MeshSource in) {
  constexpr std::string_view known[] = {"v", "vt", "vn", "f", "o", "g", "s", "mtllib", "usemtl", "l"};
  while (!in.peek_word().empty()) {
    const std::string_view word = in.peek_word();
    if (std::find(std::begin(known), std::end(known), word) != std::end(known)) return true;
    if (word[0] != '#') return false;
    in.line();
  }
  return false;
}

SurfaceFile read_known(MeshSource& in, const std::string& path, const std::string& name, const FilesBeside& beside) {
  const std::string_view bytes = in.all(), first = in.peek_word();
  if (bytes.substr(0, 4) == "glTF") return read_gltf(in, name, beside);
  if (first == "ply") return read_ply(in, name);
  if (bytes.substr(in.at(), 14) == "# vtk DataFile") return read_vtk_surface(in, name);
  if (has_stl_size(bytes)) return read_stl(in, name);
  in.refuse_wide_text();
  if (first.starts_with('{')) return read_gltf(in, name, beside);
  if (begins_with_solid(in)) return read_stl(in, name);
  const std::string foreign = core::foreign_file(bytes.substr(in.at()), core::Wanted::mesh);
  if (foreign.empty() && looks_like_obj(in)) return read_obj(in, name);
  if (foreign.empty() && core::ends_in(path, ".stl")) return read_stl(in, name);  // one whose size is wrong
  const std::string known = core::foreign_file(bytes.substr(in.at()), core::Wanted::mesh, path);
  in.lose(in.at(), tr("expected {}, got {}", kSurfaceFormats, known.empty() ? in.shown(in.at()) : known));
}

/// What the file says of the patient's axes holds for all of its parts.
void take_axes(SurfaceFile& file) {
  if (file.axes == PatientAxes::none) return;
  for (SurfacePart& part : file.parts) {
    turn_to_our_axes(file.axes, part.mesh.positions);
    if (is_mirrored(file.axes))
      for (auto& t : part.mesh.triangles) std::swap(t[1], t[2]);
  }
  if (file.metres == 0) file.metres = kPatientUnit;
  file.notes.push_back(turned_in_words(file.axes));
}

/// No way out of the folder.
bool stays_in_folder(const std::string& name) {
  const std::filesystem::path path(name);
  if (name.empty() || path.is_absolute() || path.has_root_name()) return false;
  return std::none_of(path.begin(), path.end(), [](const auto& step) { return step == ".."; });
}

std::size_t items_of(const SurfaceFile& file, bool vertices) {
  std::size_t sum = 0;
  for (const SurfacePart& part : file.parts) sum += vertices ? part.mesh.positions.size() : part.mesh.triangles.size();
  return sum;
}

/// Zeros behind a text are what a transfer has lost; behind the sign for the end of a text (0x1a) they fill a block.
void tell_of_zeros(const MeshSource& in, SurfaceFile& file) {
  const bool text = file.format == "OBJ" || std::string_view(file.format).ends_with("text");
  const std::string_view bytes = in.all();
  const std::size_t last = bytes.find_last_not_of(std::string_view("\0\x1a \t\f\v\r\n", 8));
  if (!text || last == bytes.npos) return;
  const std::string_view tail = bytes.substr(last, bytes.find('\x1a', last) - last);
  const auto zeros = std::count(tail.begin(), tail.end(), '\0');
  if (zeros > 0) file.notes.push_back(tr("{} zero bytes behind the text left out", zeros));
}

[[noreturn]] void lose_without_triangles(MeshSource& in, const SurfaceFile& file) {
  std::string message = file.points > 0 ? tr("expected triangles, got points only (a point cloud): reconstruct a "
                                             "surface first, for instance in MeshLab")
                                        : tr("expected triangles, got none");
  if (!file.notes.empty()) message += " (" + joined_notes(file.notes) + ")";
  in.lose(0, message);
}

}  // namespace

void take_head(SurfaceFile& file, std::string_view line) {
  if (file.axes == PatientAxes::none) file.axes = patient_axes_in(line);
  if (file.metres == 0) file.metres = unit_in_head(line);
  file.has_unit_in_head = file.metres > 0;
}

std::string joined_notes(const std::vector<std::string>& notes) {
  constexpr std::size_t kMostNotes = 4;
  std::string out;
  for (std::size_t i = 0; i < std::min(notes.size(), kMostNotes); ++i) out += (i ? "; " : "") + notes[i];
  return notes.size() > kMostNotes ? tr("{} and {} more", out, notes.size() - kMostNotes) : out;
}

SurfaceFile read_surfaces(std::string_view bytes, const std::string& path, const FilesBeside& beside) {
  if (bytes.size() > kMaxMeshBytes)
    throw core::BadInput({{{path, 1, 1}, tr("expected at most {} bytes, got {}", kMaxMeshBytes, bytes.size())}});
  MeshSource in(bytes, path);
  SurfaceFile file = read_known(in, path, std::filesystem::path(path).stem().string(), beside);
  in.finish();
  tell_of_zeros(in, file);
  file.points += std::int64_t(items_of(file, true));
  std::erase_if(file.parts, [](const SurfacePart& part) { return part.mesh.triangles.empty(); });
  if (file.parts.empty()) lose_without_triangles(in, file);
  bound_items(in, items_of(file, true), "vertices");
  bound_items(in, items_of(file, false), "triangles");
  if (file.axes == PatientAxes::other) in.lose(0, axes_fault());
  take_axes(file);
  if (file.has_unit_in_head)
    file.notes.push_back(tr("its head names the unit: coordinates are {}", unit_in_words(file.metres)));
  return file;
}

SurfaceFile read_surface_file(const std::filesystem::path& path) {
  const std::string bytes = core::read_file(path, kMaxMeshBytes);
  return read_surfaces(bytes, path.string(), [&path](const std::string& name) {
    if (name.find("://") != name.npos)
      throw core::BadInput({{{path.string(), 0, 0},
                             tr("expected a buffer beside the file, got an address on the internet, {}: save the file "
                                "with its buffers in it, as .glb",
                                in_quotes(name))}});
    if (!stays_in_folder(name))
      throw core::BadInput({{{path.string(), 0, 0}, "expected a file beside this one, got " + in_quotes(name)}});
    return core::read_file(path.parent_path() / name, kMaxMeshBytes);
  });
}

TriMesh joined(const SurfaceFile& file) {
  TriMesh all;
  all.positions.reserve(items_of(file, true));
  all.triangles.reserve(items_of(file, false));
  for (const SurfacePart& part : file.parts) append(all, part.mesh);
  return all;
}

TriMesh merged_equal(const TriMesh& mesh) {
  const auto& points = mesh.positions;
  std::vector<int> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    for (int k = 0; k < 3; ++k)
      if (points[a][k] != points[b][k]) return points[a][k] < points[b][k];
    return a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && points[order[i]] == points[order[i - 1]] ? first[order[i - 1]] : order[i];
  TriMesh out;
  std::vector<int> number(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (first[i] == int(i)) {
      number[i] = int(out.positions.size());
      out.positions.push_back(points[i]);
    } else {
      number[i] = number[first[i]];
    }
  }
  out.triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) out.triangles.push_back({number[a], number[b], number[c]});
  return out;
}

void bound_items(MeshSource& in, std::size_t count, const char* things) {
  if (count > kMostSurfaceItems)
    in.lose(in.at(), tr("expected at most {} {} of a surface, got {}", kMostSurfaceItems, things, count));
}

double checked_coordinate(MeshSource& in, std::size_t at, double value) {
  if (std::fabs(value) <= kMostSurfaceCoordinate) return value;
  in.fault(at, tr("expected a coordinate within {}, got {}", kMostSurfaceCoordinate, value));
  return 0;
}

Vec3d read_surface_point(MeshSource& in, int width) {
  static constexpr const char* kCoordinates[] = {"an x coordinate", "a y coordinate", "a z coordinate"};
  Vec3d point;
  for (int k = 0; k < 3; ++k) {
    in.begin_value();
    const std::size_t at = in.at();
    double value = 0;
    if (in.real(value, width, kCoordinates[k]))
      point[k] = checked_coordinate(in, at, value);
    else if (!in.binary() && !in.value_follows())
      break;  // the line is short: told once
  }
  return point;
}

std::vector<std::array<int, 3>> cut_polygons(MeshSource& in, const std::vector<Vec3d>& positions,
                                             const PolygonList& polygons, int first, int last, int from,
                                             SurfaceLeftOut& left_out) {
  std::vector<std::array<int, 3>> triangles;
  PolygonCutter cutter;
  const int count = int(positions.size());
  std::int64_t flat = 0;
  std::vector<int> corners;
  for (int p = first; p < last; ++p) {
    corners.clear();
    for (const int c : polygons.polygon(p))
      if (corners.empty() || corners.back() != c || c == PolygonList::kTold) corners.push_back(c);
    while (corners.size() > 1 && corners.front() == corners.back() && corners.back() != PolygonList::kTold)
      corners.pop_back();
    const auto bad = std::find_if(corners.begin(), corners.end(), [&](int c) { return c < 0 || c >= count; });
    if (bad == corners.end() && corners.size() < 3)
      ++flat;
    else if (bad == corners.end())
      cutter.cut(positions, corners, triangles);
    else if (std::find(corners.begin(), corners.end(), PolygonList::kTold) == corners.end())
      in.fault(polygons.at[p], tr("expected the number of a vertex from {} to {}, got {}", from, count - 1 + from,
                                  std::int64_t(*bad) + from));
  }
  left_out.take_flat(triangles, flat);
  left_out.cut_as_fans(cutter.fans());
  return triangles;
}

void add_strip(std::span<const int> strip, std::vector<std::array<int, 3>>& triangles) {
  for (std::size_t i = 2; i < strip.size(); ++i) {
    const int a = strip[i - 2], b = strip[i - 1], c = strip[i];
    if (a == b || b == c || c == a) continue;
    if (i % 2 == 0)
      triangles.push_back({a, b, c});
    else
      triangles.push_back({b, a, c});
  }
}

void SurfaceLeftOut::add(const std::string& kinds, std::int64_t count) {
  if (count == 0) return;
  for (auto& [known, sum] : m_kinds)
    if (known == kinds) {
      sum += count;
      return;
    }
  m_kinds.emplace_back(kinds, count);
}

void SurfaceLeftOut::take_flat(std::vector<std::array<int, 3>>& triangles, std::int64_t before) {
  const auto is_flat = [](const std::array<int, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
  add("faces with fewer than three different corners", before + std::int64_t(std::erase_if(triangles, is_flat)));
}

void SurfaceLeftOut::tell(std::vector<std::string>& notes) const {
  for (const auto& [kinds, count] : m_kinds) notes.push_back(tr("{} {} left out", count, kinds));
  if (m_fans > 0)
    notes.push_back(tr("{} polygons that are not convex cut as fans, as they are too many or too long", m_fans));
}

}  // namespace trocar::geometry
