// Organs touch organs: sample points (strand nodes, skin vertices) against a surface, and strands against strands.
// Where two bodies overlap in the drawn shape already (an attachment), only what comes on top is pushed apart, so that
// the drawn shape stays in equilibrium.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/strand_body.hpp>
#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

/// The sample points of one body that are tested against one surface. `overlap` is how far each one lies inside the
/// contact distance in the drawn shape [m]; samples that never take part are left out at compile.
struct SurfacePair {
  std::int32_t strand = -1, solid = -1, membrane = -1;  ///< whose samples: one of the three is set
  std::int32_t surface = 0;                             ///< which surface: organs first, then walls
  std::vector<std::int32_t> sample;                     ///< strand nodes, skin vertices, or membrane nodes
  std::vector<float> radius;                            ///< of each sample [m]; 0 for skin vertices
  std::vector<float> overlap;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("strand", s.strand), v("solid", s.solid), v("membrane", s.membrane), v("surface", s.surface),
        v("sample", s.sample), v("radius", s.radius), v("overlap", s.overlap);
  }
};

/// One strand against another: elements of `a` from..to, tested against all of `b`.
struct StrandPair {
  std::int32_t a = 0, b = 0;
  std::vector<float> overlap;  ///< per element of a

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("a", s.a), v("b", s.b), v("overlap", s.overlap);
  }
};

/// @param nearest (samples) State: vertex where each sample was last; of samples far from there it is looked for in
/// turn
/// @param tick    whose turn it is
/// @param strand_loads  of the strand whose samples these are
void strand_on_surface(const SurfacePair& pair, const StrandBody& body, const tissue::StrandState& state,
                       const Surface& surface, std::uint64_t tick, std::span<std::int32_t> nearest,
                       StrandLoads& strand_loads, NetworkLoads* surface_loads) noexcept;
void solid_on_surface(const SurfacePair& pair, const Surface& samples, const Surface& surface, std::uint64_t tick,
                      std::span<std::int32_t> nearest, NetworkLoads& sample_loads,
                      NetworkLoads* surface_loads) noexcept;

/// @param tick    whose turn it is to look, of elements that are not near
/// @param nearest (elements of a) State: element of b that was nearest last
/// @param side    (elements of a) State: unit vector from b to a where they are near, so that they cannot cross
void strand_on_strand(const StrandPair& pair, const StrandBody& a, const tissue::StrandState& a_state,
                      const StrandBody& b, const tissue::StrandState& b_state, std::uint64_t tick,
                      std::span<std::int32_t> nearest, std::span<Vec3f> side, StrandLoads& a_loads,
                      StrandLoads& b_loads) noexcept;

}  // namespace trocar::interactions
