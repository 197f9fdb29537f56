// How a sling's loop lies where nothing but its own memory shapes it: a pear in the plane of the tube's axis. Both
// threads leave along the tube, bend apart, go straight on and meet in an arc; all of it grows with the thread that
// there is. docs/guides/endoloop.md.
#pragma once

#include <trocar/interactions/objects/suture.hpp>

namespace trocar::interactions {

inline constexpr double kThreadsApart = 0.55;  ///< of its thickness, from the tube's axis, where it leaves the mouth

/// Lays `thread` of it [m] so at the mouth, at rest and without twist, the rest on the tube's axis. Its bends there are
/// those that it has of its own.
void lay_loop(const SutureModel& m, double thread, SutureState& s) noexcept;

/// While it lies loose, its bends of its own stay those of such a pear of as much thread as there is. They are kept in
/// the mouth's frame and not in the thread's: those would turn about it with every bend elsewhere, without the work
/// that takes, and the loop would roll itself up.
void keep_shape(const SutureModel& m, double thread, SutureState& s) noexcept;

}  // namespace trocar::interactions
