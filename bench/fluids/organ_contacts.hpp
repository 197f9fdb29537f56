// What fluids meet in a scene that stands still: the skins of its organs and walls as a soup of triangles in a grid.
// For pictures only; the simulation's own contacts are another matter.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/fluids/droplets.hpp>
#include <trocar/fluids/pool.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/view/fluids/fluid_drawing.hpp>

namespace trocar {

class OrganContacts {
 public:
  OrganContacts(const sim::Model& model, const sim::State& state);

  struct Near {
    float off = 1;  ///< signed distance [m], > 0 outside
    Vec3f point, normal;
    std::int32_t triangle = -1;
  };
  /// The nearest surface within 4 mm.
  Near nearest(Vec3f p) const;
  /// The first surface on the way from a to b, or the nearest at b.
  Near first_on_way(Vec3f a, Vec3f b) const;
  std::int32_t body_of(std::int32_t triangle) const { return m_triangles[std::size_t(triangle)].body; }

  /// Heights of what can hold a pool: walls and those organs, seen from above.
  std::vector<float> floor_of(const fluids::PoolModel& pool, std::span<const int> solids) const;
  /// Places of film, one a 1.5 mm cube that a surface passes through.
  const std::vector<view::FilmPlace>& places() const { return m_places; }
  std::int32_t place_at(Vec3f p) const;

  int solids = 0;

 private:
  struct Triangle {
    Vec3f a, b, c, normal;
    std::int32_t body;
  };
  void add(std::span<const Vec3f> points, std::span<const std::array<int, 3>> triangles, std::int32_t body);
  void sort_into_cells();
  void make_places();
  std::int64_t key(Vec3f p, float edge) const;
  Near near_triangle(std::int32_t t, Vec3f p) const;

  std::vector<Triangle> m_triangles;
  std::vector<std::pair<std::int64_t, std::int32_t>> m_cells;  ///< (cell, triangle), sorted
  std::vector<std::pair<std::int64_t, std::int32_t>> m_place;  ///< (cell, place), sorted
  std::vector<view::FilmPlace> m_places;
};

}  // namespace trocar
