// Wavefront OBJ, the part that carries a triangle mesh.
#include <iomanip>
#include <istream>
#include <limits>
#include <locale>
#include <ostream>
#include <sstream>

#include <trocar/core/error.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {
namespace {

class ObjReader {
 public:
  explicit ObjReader(std::string name) : m_name(std::move(name)) {}

  TriMesh read(std::istream& in) {
    for (std::string line; std::getline(in, line);) {
      ++m_line;
      read_line(line);
    }
    check_indices();
    if (!m_faults.empty()) throw core::BadInput(m_faults);
    return m_mesh;
  }

 private:
  void fault(int line, std::string message) {
    core::Fault fault;
    fault.at.file = m_name;
    fault.at.line = line;
    fault.message = std::move(message);
    m_faults.push_back(std::move(fault));
  }

  void read_line(const std::string& line) {
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    std::string keyword;
    words >> keyword;
    if (keyword == "v") read_vertex(words, line);
    if (keyword == "f") read_face(words);
  }

  void read_vertex(std::istringstream& words, const std::string& line) {
    Vec3d p;
    if (!(words >> p.x >> p.y >> p.z)) fault(m_line, "expected three numbers after 'v', got '" + line + "'");
    m_mesh.positions.push_back(p);
  }

  void read_face(std::istringstream& words) {
    std::vector<int> corners;
    for (std::string word; words >> word;) corners.push_back(vertex_index(word));
    if (corners.size() < 3) fault(m_line, "expected at least 3 corners, got " + std::to_string(corners.size()));
    for (std::size_t k = 2; k < corners.size(); ++k) {
      m_mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
      m_line_of_triangle.push_back(m_line);
    }
  }

  // "7", "7/1", "7/1/2", "7//2", "-1": the first number, from 1 or from the end.
  int vertex_index(const std::string& word) {
    std::istringstream digits(word.substr(0, word.find('/')));
    int index = 0;
    if (!(digits >> index) || index == 0) {
      fault(m_line, "expected a vertex number, got '" + word + "'");
      return 0;
    }
    return index > 0 ? index - 1 : static_cast<int>(m_mesh.positions.size()) + index;
  }

  void check_indices() {
    const int count = static_cast<int>(m_mesh.positions.size());
    for (std::size_t t = 0; t < m_mesh.triangles.size(); ++t)
      for (int vertex : m_mesh.triangles[t])
        if (vertex < 0 || vertex >= count)
          fault(m_line_of_triangle[t],
                "expected a vertex number from 1 to " + std::to_string(count) + ", got " + std::to_string(vertex + 1));
  }

  std::string m_name;
  int m_line = 0;
  TriMesh m_mesh;
  std::vector<int> m_line_of_triangle;
  std::vector<core::Fault> m_faults;
};

}  // namespace

void write_obj(std::ostream& out, const TriMesh& mesh) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(std::numeric_limits<double>::max_digits10);
  for (const Vec3d& p : mesh.positions) text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& t : mesh.triangles) text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  out << text.str();
}

TriMesh read_obj(std::istream& in, const std::string& name) { return ObjReader(name).read(in); }

}  // namespace trocar::geometry
