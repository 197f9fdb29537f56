// Figures by United States Pharmacopeia size. Diameters are the middle of the permitted range; mass, EA and EI of the
// makes are those of the solid (PDS, E = 1.5 GPa) or of a braid (9 GPa along it, a thirtieth of a solid's bending).
// A knotted thread bears the pharmacopeia's knot pull: the least mean of its monograph for synthetic absorbable sutures
// (3-0: 1.77 kgf = 17.4 N), measured as in its chapter 881. The same figures for silk and polyester are our estimate:
// the monograph for nonabsorbable sutures asks for less. A straight thread bears about 1/0.6 of it. PDS yields at 5 %
// of strain on its outside; in a braid fibres slide from a third of that curvature on. Friction: Johanns et al. 2023
// for thread on thread; braid rubs more than monofilament.
#include <trocar/suture/thread/sizes.hpp>

namespace trocar::suture {
namespace {

constexpr ThreadStuff stuff_of(double diameter_mm, double mass_mg, double stretch, double bend, double knot_pull,
                               bool braid) {
  ThreadStuff t;
  t.diameter = 1e-3 * diameter_mm;
  t.stretch = stretch;
  t.bend = bend;
  t.twist = bend / 1.4;
  t.yield_curvature = (braid ? 0.03 : 0.05) / (0.5 * t.diameter);
  t.hardening = 0.05;
  t.mass = 1e-6 * mass_mg;
  t.friction_thread = braid ? 0.25 : 0.2;
  t.friction_steel = 0.15;
  t.friction_tissue = braid ? 0.2 : 0.1;
  t.knotted_break_force = knot_pull;
  t.break_force = knot_pull / 0.6;
  return t;
}

constexpr ThreadKind kThreadKinds[] = {
    {"0", "PDS", "monofilament", stuff_of(0.375, 145, 166, 1.5e-6, 38.2, false)},
    {"2-0", "PDS", "monofilament", stuff_of(0.325, 110, 124, 8e-7, 26.3, false)},
    {"3-0", "PDS", "monofilament", stuff_of(0.225, 53, 60, 1.9e-7, 17.4, false)},
    {"4-0", "PDS", "monofilament", stuff_of(0.175, 31, 36, 7e-8, 9.3, false)},
    {"5-0", "PDS", "monofilament", stuff_of(0.125, 16, 18, 1.8e-8, 6.7, false)},
    {"0", "silk", "braid", stuff_of(0.375, 145, 990, 2.6e-7, 38.2, true)},
    {"2-0", "silk", "braid", stuff_of(0.325, 110, 750, 1.5e-7, 26.3, true)},
    {"3-0", "silk", "braid", stuff_of(0.225, 53, 360, 3.4e-8, 17.4, true)},
    {"4-0", "silk", "braid", stuff_of(0.175, 31, 215, 1.2e-8, 9.3, true)},
    {"5-0", "silk", "braid", stuff_of(0.125, 16, 110, 3e-9, 6.7, true)},
    {"0", "polyester", "braid", stuff_of(0.375, 145, 990, 2.6e-7, 38.2, true)},
    {"2-0", "polyester", "braid", stuff_of(0.325, 110, 750, 1.5e-7, 26.3, true)},
    {"3-0", "polyester", "braid", stuff_of(0.225, 53, 360, 3.4e-8, 17.4, true)},
    {"4-0", "polyester", "braid", stuff_of(0.175, 31, 215, 1.2e-8, 9.3, true)},
    {"5-0", "polyester", "braid", stuff_of(0.125, 16, 110, 3e-9, 6.7, true)},
};

}  // namespace

std::span<const ThreadKind> thread_kinds() noexcept { return kThreadKinds; }

const ThreadKind* find_thread(std::string_view size, std::string_view make) noexcept {
  for (const ThreadKind& kind : kThreadKinds)
    if (size == kind.size && make == kind.make) return &kind;
  return nullptr;
}

}  // namespace trocar::suture
