// How a sling moves: it is carried in, fed out, drawn closed, and its knot leaves the mouth and comes back to it. What
// the hand does comes in with SutureWork::sling; sim/bodies/sling.hpp says which hand has which.
//
//   if (lead_sling(model, dt, state, work)) ... the thread advances ... settle_sling(model, dt, state, work);
#pragma once

#include <trocar/interactions/objects/suture.hpp>

namespace trocar::interactions {

inline constexpr double kFeeds = 0.060;        ///< [m/s] an opened handle feeds the loop out.             [d]
inline constexpr double kDraws = 0.040;        ///< [m/s] at most, a closing one draws thread in.          [d]
inline constexpr double kTubeRubs = 0.03;      ///< [N] of the thread in its tube.                         [d]
inline constexpr double kStowsWithin = 0.040;  ///< [m] of the instrument in the body: less, and it is packed. [d]
inline constexpr double kLeastLoop = 0.006;    ///< [m] of thread that a knot cannot close any more

/// The last node of the thread that is out of the tube and there to be seen; all of a suture that is no sling.
int last_out(const SutureModel& m, const SutureState& s) noexcept;
/// Is that part of that hand's instrument the tube's end, which the thread comes out of?
bool is_own_mouth(const SutureModel& m, const SutureState& s, const SutureRod& rod) noexcept;

/// A hand takes it, or puts it down.
void take_sling(const SutureModel& m, std::int32_t hand, SutureState& s) noexcept;
void put_down_sling(const SutureModel& m, SutureState& s) noexcept;
/// Before the thread advances: thread is fed and drawn, the holds are where the instrument is.
/// @return false: it is carried along, and nothing of it is to be computed
bool lead_sling(const SutureModel& m, double dt, SutureState& s, SutureWork& w) noexcept;
/// After it.
void settle_sling(const SutureModel& m, double dt, SutureState& s, SutureWork& w) noexcept;
/// The first element that has been parted of what is out; -1: none.
int parted_element(const SutureModel& m, const SutureState& s) noexcept;
/// The thread has been cut in that element: the loop stays with its knot, the rest goes back into the tube.
void cut_sling(const SutureModel& m, std::int32_t element, SutureState& s) noexcept;

}  // namespace trocar::interactions
