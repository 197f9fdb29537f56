// How one person's scores at one exercise have developed: the last, the best, the median, and the curve.
//
//   const Standing s = read_standing(store, "Ada", "basics/camera-0");
//   if (s.best) show(*s.best);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <trocar/training/store/store.hpp>

namespace trocar::training {

struct Standing {
  std::vector<double> scores;  ///< of finished attempts with a score, oldest first; 0..100
  std::optional<double> last, best, median;
};

Standing standing_of(std::vector<double> scores);
/// At most the newest `most` attempts count. Empty where the store cannot be read.
Standing read_standing(const Store& store, const std::string& trainee, const std::string& exercise, int most = 200);

}  // namespace trocar::training
