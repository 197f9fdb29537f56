// Numbers in groups that are joined two by two: the parts of a mesh.
//
//   Groups parts(triangles);
//   parts.join(a, b);
//   if (parts.root(a) == a) ...       // once a group: the lowest number in it
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace trocar::geometry {

class Groups {
 public:
  explicit Groups(std::size_t count) : m_up(count) { std::iota(m_up.begin(), m_up.end(), 0); }
  int root(int i) {
    while (m_up[i] != i) i = m_up[i] = m_up[m_up[i]];
    return i;
  }
  void join(int a, int b) {
    a = root(a), b = root(b);
    m_up[std::max(a, b)] = std::min(a, b);
  }
  int count() const {
    int roots = 0;
    for (int i = 0; i < int(m_up.size()); ++i) roots += m_up[i] == i;
    return roots;
  }

 private:
  std::vector<int> m_up;
};

}  // namespace trocar::geometry
