#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include <trocar/geometry/surfaces/fill_holes.hpp>

namespace trocar::geometry {

std::vector<std::vector<int>> rims(const TriMesh& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (++uses[{t[k], t[(k + 1) % 3]}] > 1)
        throw std::invalid_argument("rims: triangles that share an edge are turned against each other");
  std::map<int, int> next;  // along a rim, against the triangle that has the edge
  for (const auto& [edge, n] : uses) {
    if (uses.count({edge.second, edge.first})) continue;
    if (!next.emplace(edge.second, edge.first).second)
      throw std::invalid_argument("rims: two rims touch in vertex " + std::to_string(edge.second));
  }
  std::vector<std::vector<int>> result;
  while (!next.empty()) {
    std::vector<int> rim;
    for (auto at = next.begin(); at != next.end(); at = next.find(rim.back())) {
      if (rim.empty()) rim.push_back(at->first);
      const int other = at->second;
      next.erase(at);
      if (other == rim.front()) break;
      rim.push_back(other);
    }
    result.push_back(rim);
  }
  return result;
}

TriMesh filled_holes(const TriMesh& mesh) {
  TriMesh result = mesh;
  for (const std::vector<int>& rim : rims(mesh)) {
    Vec3d middle;
    for (int v : rim) middle += mesh.positions[v] / double(rim.size());
    const int top = static_cast<int>(result.positions.size());
    result.positions.push_back(middle);
    for (std::size_t k = 0; k < rim.size(); ++k) result.triangles.push_back({rim[k], rim[(k + 1) % rim.size()], top});
  }
  return result;
}

}  // namespace trocar::geometry
