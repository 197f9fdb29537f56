// How a handle moves the jaws through the rod and bars between them: a table that scene/mechanisms makes once by
// closing the linkage's loop at each of its places. Without one, jaws open as the handle does, and a pinch is as strong
// wherever the jaws are.
#pragma once

#include <trocar/core/fields.hpp>

namespace trocar::interactions {

inline constexpr int kLinkageSteps = 64;

struct LinkageModel {
  bool there = false;
  /// At handle k / kLinkageSteps. Opening as a share of the open jaws', 1 .. 0, falling all the way; and how much of
  /// the closed jaws' leverage there is: force between the jaws per force at the handle, which by virtual work is how
  /// far the handle goes for the jaws' way.
  double aperture[kLinkageSteps + 1] = {};
  double leverage[kLinkageSteps + 1] = {};

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("aperture", s.aperture), v("leverage", s.leverage), v("there", s.there, core::kNotHashed);
  }
};

/// Jaws without tissue between them. @param handle 0 open .. 1 closed
double aperture_of(const LinkageModel& linkage, double handle) noexcept;
/// The handle that holds the jaws so far open.
double handle_of(const LinkageModel& linkage, double aperture) noexcept;
/// Relative to the closed jaws'; 1 without a linkage.
double leverage_at(const LinkageModel& linkage, double aperture) noexcept;

}  // namespace trocar::interactions
