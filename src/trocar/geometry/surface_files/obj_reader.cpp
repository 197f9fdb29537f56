// Wavefront OBJ, the part of it that carries surfaces: v, f, o, g. Lines that end in a backslash continue.
// [Wavefront: Advanced Visualizer manual, appendix B1, "Object files"]
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>

namespace trocar::geometry {
namespace {

class ObjSurface {
 public:
  ObjSurface(MeshSource& in, const std::string& name) : m_in(in), m_name(name) {}

  SurfaceFile read() {
    m_in.set_records_on_lines(true);
    m_runs.push_back({m_name, 0});
    while (!m_in.only_padding_left()) line();
    SurfaceFile file = m_head;
    file.format = "OBJ";
    if (m_polygons.count() == 0) file.points = std::int64_t(m_positions.size());
    for (std::size_t r = 0; r < m_runs.size(); ++r) add_part(file, r);
    merge_names(file);
    m_left_out.tell(file.notes);
    return file;
  }

 private:
  /// Polygons from one on that have one name.
  struct Run {
    std::string name;
    int first;
  };
  MeshSource& m_in;
  std::string m_name, m_object, m_group;
  std::vector<Vec3d> m_positions;
  PolygonList m_polygons;
  std::vector<Run> m_runs;
  SurfaceFile m_head;  ///< what comments say
  SurfaceLeftOut m_left_out;

  void line() {
    m_in.skip_space();
    const std::size_t at = m_in.at();
    const std::string_view keyword = m_in.word();
    if (keyword.starts_with('#')) {
      m_in.go_to(at);
      comment(m_in.line());
      return;
    }
    if (keyword == "v") {
      bound_items(m_in, m_positions.size(), "vertices");
      m_positions.push_back(read_surface_point(m_in, 8));  // what may follow is a weight or a colour
    } else if (keyword == "f" || keyword == "fo") {
      face();
    } else if (keyword == "o" || keyword == "g") {
      name(keyword == "o" ? m_object : m_group);
    } else if (keyword == "l" || keyword == "p") {
      m_left_out.add(keyword == "l" ? "lines" : "points");
    } else if (keyword == "surf" || keyword == "curv" || keyword == "curv2") {
      m_left_out.add("free-form curves and surfaces");
    }
    pass_line();
  }

  /// What 3D Slicer writes in front of all vertices.
  void comment(std::string_view text) {
    if (m_positions.empty()) take_head(m_head, text);
  }

  /// To the end of the line, and of those that it continues in.
  void pass_line() {
    for (std::string_view rest = m_in.line(); !rest.empty() && rest.back() == '\\' && m_in.left() > 0;)
      rest = m_in.line();
  }

  void name(std::string& of) {
    const std::size_t at = m_in.at();
    of = std::string(m_in.line().substr(0, 200));
    m_in.go_to(at);
    const std::string both = m_object.empty() || m_group.empty() ? m_object + m_group : m_object + '/' + m_group;
    if (m_runs.back().first == m_polygons.count()) m_runs.pop_back();
    m_runs.push_back({both.empty() ? m_name : both, m_polygons.count()});
  }

  void face() {
    const std::size_t at = m_in.at();
    while (m_in.word_on_line()) {
      const std::size_t word_at = m_in.at();
      const std::string_view word = m_in.word();
      if (word == "\\")
        m_in.skip_space();
      else
        m_polygons.corners.push_back(corner(word, word_at));
    }
    m_polygons.end_polygon(m_in, at);
  }

  /// "7", "7/1", "7/1/2", "7//2", "-1": the first number, from 1 or back from the latest vertex.
  int corner(std::string_view word, std::size_t at) {
    const auto number = core::to_integer(word.substr(0, word.find('/')));
    const std::int64_t count = std::int64_t(m_positions.size());
    if (number && *number > 0 && *number <= std::int64_t(kMostSurfaceItems)) return int(*number - 1);
    if (number && *number < 0 && -*number <= count) return int(count + *number);
    m_in.fault(at, tr("expected the number of a vertex, from 1 or back from -1, got {}", in_quotes(word)));
    return PolygonList::kTold;
  }

  void add_part(SurfaceFile& file, std::size_t run) {
    const int first = m_runs[run].first, last = run + 1 < m_runs.size() ? m_runs[run + 1].first : m_polygons.count();
    SurfacePart part{m_runs[run].name, {}};
    part.mesh.triangles = cut_polygons(m_in, m_positions, m_polygons, first, last, 1, m_left_out);
    file.parts.push_back(std::move(part));
  }

  /// Runs of one name are one part; each part has the vertices that it uses, but a single one keeps all.
  void merge_names(SurfaceFile& file) {
    std::vector<SurfacePart> merged;
    std::vector<std::pair<std::string, std::size_t>> by_name;
    for (SurfacePart& part : file.parts) by_name.emplace_back(part.name, by_name.size());
    std::sort(by_name.begin(), by_name.end());
    std::vector<std::size_t> first(by_name.size());
    for (std::size_t i = 0; i < by_name.size(); ++i)
      first[by_name[i].second] =
          i > 0 && by_name[i].first == by_name[i - 1].first ? first[by_name[i - 1].second] : by_name[i].second;
    for (std::size_t p = 0; p < file.parts.size(); ++p) {
      auto& from = file.parts[p].mesh.triangles;
      auto& to = file.parts[first[p]].mesh.triangles;
      if (first[p] == p || from.empty()) continue;
      to.insert(to.end(), from.begin(), from.end());
      from.clear();
    }
    for (SurfacePart& part : file.parts)
      if (!part.mesh.triangles.empty()) merged.push_back(std::move(part));
    for (SurfacePart& part : merged) take_vertices(part.mesh, merged.size() == 1);
    file.parts = std::move(merged);
  }

  void take_vertices(TriMesh& mesh, bool all) {
    if (all) {
      mesh.positions = m_positions;
      return;
    }
    std::vector<int> used;
    for (const auto& t : mesh.triangles) used.insert(used.end(), t.begin(), t.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const int v : used) mesh.positions.push_back(m_positions[v]);
    for (auto& t : mesh.triangles)
      for (int& v : t) v = int(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  }
};

}  // namespace

SurfaceFile read_obj(MeshSource& in, const std::string& name) { return ObjSurface(in, name).read(); }

}  // namespace trocar::geometry
