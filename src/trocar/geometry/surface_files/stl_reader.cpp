// STL as text or binary. Binary files are recognised by their size, as many of them begin with "solid", too.
//
//   solid NAME / facet normal x y z / outer loop / vertex x y z, three times / endloop / endfacet / endsolid
//   80 bytes, uint32 n, n times: float normal[3], float corner[3][3], uint16                      little-endian
//
// Normals are not looked at: corners say the same.
#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>

namespace trocar::geometry {
namespace {

constexpr std::size_t kStlHead = 84, kStlTriangle = 50;

std::uint64_t stl_announced(std::string_view bytes) {
  std::uint64_t count = 0;
  for (std::size_t k = 0; k < 4; ++k) count |= std::uint64_t(static_cast<unsigned char>(bytes[80 + k])) << (8 * k);
  return count;
}

bool is_word(std::string_view word, std::string_view lower_case) {
  if (word.size() != lower_case.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((word[i] >= 'A' && word[i] <= 'Z' ? char(word[i] - 'A' + 'a') : word[i]) != lower_case[i]) return false;
  return true;
}

void stl_binary(MeshSource& in, TriMesh& mesh) {
  const std::string_view bytes = in.all();
  in.set_form(MeshSource::Form::binary);
  if (bytes.size() < kStlHead)
    in.lose(0,
            tr("expected a head of {} bytes of a binary STL, or the word solid, got {} bytes", kStlHead, bytes.size()));
  const std::uint64_t count = stl_announced(bytes), most = (bytes.size() - kStlHead) / kStlTriangle;
  if (!has_stl_size(bytes))
    in.lose(80, tr("expected {} triangles, which is what {} bytes are the size of, got {} announced", most,
                   bytes.size(), count));
  bound_items(in, count, "triangles");
  mesh.positions.reserve(3 * std::size_t(count));
  for (std::size_t t = 0; t < count; ++t) {
    in.go_to(kStlHead + kStlTriangle * t + 12);
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(read_surface_point(in, 4));
  }
}

class StlText {
 public:
  StlText(MeshSource& in, SurfaceFile& file, const std::string& name) : m_in(in), m_file(file), m_name(name) {}

  void read() {
    while (!m_in.peek_word().empty()) solid();
  }

 private:
  MeshSource& m_in;
  SurfaceFile& m_file;
  std::string m_name;

  void solid() {
    expect("solid");
    const std::string name(m_in.line().substr(0, 200));
    m_file.parts.push_back({name.empty() ? m_name : name, {}});
    while (!is_word(m_in.peek_word(), "endsolid")) facet(m_file.parts.back().mesh);
    m_in.line();
  }

  void facet(TriMesh& mesh) {
    expect("facet");
    m_in.line();  // the normal
    expect("outer");
    expect("loop");
    m_in.set_records_on_lines(true);
    for (int k = 0; k < 3; ++k) {
      expect("vertex");
      mesh.positions.push_back(read_surface_point(m_in, 4));
      m_in.end_record();
    }
    m_in.set_records_on_lines(false);
    expect("endloop");
    expect("endfacet");
    bound_items(m_in, mesh.positions.size() / 3, "triangles");
  }

  void expect(std::string_view word) {
    m_in.skip_space();
    const std::size_t at = m_in.at();
    if (!is_word(m_in.word(), word)) m_in.lose(at, tr("expected '{}', got {}", word, m_in.shown(at)));
  }
};

/// Every three positions are a triangle; those at the same place become one.
void close_corners(TriMesh& soup) {
  for (int v = 0; v + 2 < int(soup.positions.size()); v += 3) soup.triangles.push_back({v, v + 1, v + 2});
  soup = merged_equal(soup);
}

}  // namespace

bool has_stl_size(std::string_view bytes) {
  return bytes.size() >= kStlHead && stl_announced(bytes) * kStlTriangle + kStlHead == bytes.size();
}

SurfaceFile read_stl(MeshSource& in, const std::string& name) {
  SurfaceFile file;
  if (!has_stl_size(in.all()) && is_word(in.peek_word(), "solid")) {
    file.format = "STL, text";
    StlText(in, file, name).read();
  } else {
    file.format = "STL, binary";
    file.parts.push_back({name, {}});
    stl_binary(in, file.parts.front().mesh);
  }
  for (SurfacePart& part : file.parts) close_corners(part.mesh);
  return file;
}

}  // namespace trocar::geometry
