// What threads are made of: diameters by United States Pharmacopeia size, and what each make does when it is pulled,
// bent and rubbed. Whatever a row does not say follows from its diameter and its make.
//
//   const ThreadStuff* stuff = find_thread("3-0", "PDS");     // nullptr: no such size or make
#pragma once

#include <span>
#include <string_view>

#include <trocar/core/fields.hpp>

namespace trocar::suture {

/// A thread's section and surface.
struct ThreadStuff {
  double diameter = 0;             ///< [m]
  double stretch = 0;              ///< EA [N]
  double bend = 0;                 ///< EI [N m^2]
  double twist = 0;                ///< GJ [N m^2]
  double yield_curvature = 0;      ///< beyond which bends stay [1/m]; its moment is EI times that; 0: never
  double hardening = 0;            ///< slope of the moment beyond, as a share of EI
  double mass = 0;                 ///< [kg/m]
  double friction_thread = 0;      ///< of thread on thread
  double friction_steel = 0;       ///< on shafts, jaws, needles
  double friction_tissue = 0;      ///< on skins and in passages
  double break_force = 0;          ///< [N]
  double knotted_break_force = 0;  ///< with a knot in it [N]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("diameter", s.diameter), v("stretch", s.stretch), v("bend", s.bend), v("twist", s.twist),
        v("yield_curvature", s.yield_curvature), v("hardening", s.hardening), v("mass", s.mass),
        v("friction_thread", s.friction_thread), v("friction_steel", s.friction_steel),
        v("friction_tissue", s.friction_tissue), v("break_force", s.break_force),
        v("knotted_break_force", s.knotted_break_force);
  }
};

struct ThreadKind {
  const char *size, *make;  ///< "3-0"; "PDS", "silk", "polyester"
  const char* look;         ///< "monofilament" or "braid"
  ThreadStuff stuff;
};

/// All sizes of all makes.
std::span<const ThreadKind> thread_kinds() noexcept;
/// nullptr where there is none of that size and make.
const ThreadKind* find_thread(std::string_view size, std::string_view make) noexcept;

}  // namespace trocar::suture
