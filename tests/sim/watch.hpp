// How long bodies of a scene pass through each other deeper than some bound, by the independent measure
// (interpenetration.hpp): between two looks that both find a pair deeper it counts as deeper all the time.
//
//   Watch watch(model, initial_state(model), "gallbladder", {"gallbladder", "colon"});
//   ... every Watch::kEvery ticks: watch.look(state);
//   EXPECT_EQ(watch.found(), "");
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "interpenetration.hpp"

namespace trocar {

class Watch {
 public:
  static constexpr int kEvery = 50;  ///< [ticks]

  /// @param start  what overlaps there may, as deep
  /// @param of     pairs that this surface is one of
  /// @param names  surfaces that are measured against each other
  Watch(const sim::Model& model, const sim::State& start, std::string of, std::vector<std::string> names,
        double bound = 0.001)
      : m_model(model), m_of(std::move(of)), m_names(std::move(names)), m_bound(bound), m_start(measured(start)) {}

  void look(const sim::State& s) {
    const Interpenetration now = measured(s);
    std::map<std::pair<int, int>, double> deep;
    for (const Growth& g : deeper_than(now, m_start, m_bound)) {
      const std::string &a = now.names[std::size_t(g.now.a)], &b = now.names[std::size_t(g.now.b)];
      if ((a != m_of && b != m_of) || a == b) continue;
      m_deepest = std::max(m_deepest, g.now.depth - g.before);
      deep[{g.now.a, g.now.b}] = g.now.depth;
      if (m_deep.count({g.now.a, g.now.b}) == 0) continue;
      const std::string text = "tick " + std::to_string(s.tick) + ": " + text_of(now, g) + "\n";
      if (m_lines++ < 12) m_found += text;
    }
    m_deep = std::move(deep);
  }
  /// Pairs that were too deep at two looks in a row; empty: none.
  const std::string& found() const { return m_found; }
  double deepest() const { return m_deepest; }  ///< beyond the start's, at any look [m]; 0: never beyond the bound

 private:
  Interpenetration measured(const sim::State& s) const {
    std::vector<BodySurface> all = surfaces_of(m_model, s);
    for (BodySurface& b : all)
      if (std::find(m_names.begin(), m_names.end(), b.name) == m_names.end())
        b.points.clear(), b.triangles.clear(), b.capsules.clear();
    return measure(all);
  }

  const sim::Model& m_model;
  std::string m_of;
  std::vector<std::string> m_names;
  double m_bound;
  Interpenetration m_start;
  std::map<std::pair<int, int>, double> m_deep;
  std::string m_found;
  double m_deepest = 0;
  int m_lines = 0;
};

}  // namespace trocar
