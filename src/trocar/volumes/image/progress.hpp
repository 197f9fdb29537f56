// Long computations report their progress through this, and can be stopped.
//
//   read_volume(path, {.progress = [&](double share) { bar = share; return !stop; }});
#pragma once

#include <functional>
#include <stdexcept>

namespace trocar::volumes {

/// Called now and then with the share that is done, 0 .. 1, from the calling thread; false: stop. May be empty.
using Progress = std::function<bool(double share)>;

/// Thrown where a Progress said so; nothing was changed.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

inline void tell(const Progress& progress, double share) {
  if (progress && !progress(share)) throw Cancelled();
}
/// The part of another's progress from `from` to `to`.
inline Progress part(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double share) { return progress(from + share * (to - from)); };
}

}  // namespace trocar::volumes
