// Fat (tissue/fat/fat.hpp) as a body of a scene. What its lobules hold on are bonds (couplings/bonds.hpp).
#pragma once

#include <string>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/tissue/fat/fat.hpp>

namespace trocar::interactions {

/// Lobules that are drawn as one thing of another look: a lymph node. Mechanics know nothing of it.
struct FatNodule {
  std::string look;
  std::vector<std::int32_t> lobules;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("look", s.look, core::kNotHashed), v("lobules", s.lobules, core::kNotHashed);
  }
};

struct FatBody {
  std::string name, look;
  tissue::FatModel fat;
  std::int32_t roots = -1;  ///< set of bonds by which its lobules hang on other bodies
  std::vector<FatNodule> nodules;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("fat", s.fat), v("roots", s.roots), v("name", s.name, core::kNotHashed), v("look", s.look, core::kNotHashed),
        v("nodules", s.nodules, core::kNotHashed);
  }
};

struct FatBodyWork {
  tissue::FatWork fat;
  NetworkLoads loads;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("fat", s.fat), v("loads", s.loads);
  }
};

}  // namespace trocar::interactions
