// What a cut looks like where it runs along the faces of cells: those are stairs, tissue parts in a line. Rims are
// smoothed along themselves, what is bare within them, and the skin around goes along (drawn only).
//
//   CutShape shape;
//   shape.find(skin);              // after every cut
//   shape.smooth(positions);       // whenever the body has moved
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>
#include <trocar/tissue/tets/face_skin.hpp>

namespace trocar::view {

class CutShape {
 public:
  /// Of a skin without bare faces nothing is left to smooth.
  void find(const tissue::FaceSkin& skin);
  /// @param positions  (vertices of the skin) [m]
  void smooth(std::span<Vec3f> positions);

  /// How far a vertex of the body's own surface is from the next rim, along edges at rest [m]; kFar beyond a few.
  float from_rim(std::size_t vertex) const { return m_spot[vertex] < 0 ? kFar : m_far[std::size_t(m_spot[vertex])]; }
  /// Along the skin away from the cut, of a vertex at the rim, unit; of others 0. As of the last smooth().
  Vec3f outwards(std::size_t vertex) const;

  static constexpr float kFar = 1.0f;

 private:
  enum class Kind : std::uint8_t { skin, rim, bare };
  struct Edge {
    int a, b;
    bool bare, skin;  ///< of triangles of which kind
  };
  std::vector<Edge> join(const tissue::FaceSkin& skin);
  void measure(const tissue::FaceSkin& skin, std::span<const Edge> edges);
  void keep_near(std::vector<Edge>& edges);
  void list_beside(std::span<const Edge> edges);
  void find_ends(const tissue::FaceSkin& skin);
  void look_outwards();
  /// Towards the mean of their neighbours.
  template <class Wanted>
  void relax(float share, Wanted&& wanted);

  std::vector<int> m_spot;   ///< (vertices) where they are: those of skin and flesh at a rim are in one; -1: far off
  std::vector<Kind> m_kind;  ///< (spots)
  std::vector<float> m_far;  ///< (spots) from the rim [m]
  std::vector<std::uint8_t> m_end;              ///< (spots) 1: of a slit
  std::vector<std::int32_t> m_first;            ///< (spots + 1) into m_beside
  std::vector<std::int32_t> m_beside;           ///< neighbours; along a rim only those on it
  std::vector<Vec3f> m_place, m_shift, m_next;  ///< (spots) [m]
  std::vector<Vec3f> m_outwards;                ///< (spots)
};

}  // namespace trocar::view
