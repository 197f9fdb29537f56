// Which of several volumes of a file or folder is shown: lists of series, time points and phases.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <trocar/volumes/files/volume_file.hpp>

namespace trocar::app {

struct ScanWish {
  int series = 0;            ///< 1, 2, ... as the report lists them; 0: the file's own
  std::optional<int> frame;  ///< from 0; none: the file's own
};

/// A dialogue with the series of which one must be chosen. None: nothing was chosen yet.
/// @param open  becomes false where the user cancels
std::optional<ScanWish> draw_series_dialogue(const std::string& file, const std::vector<volumes::SeriesFacts>& series,
                                             bool& open);

/// Lists of what there is beside the volume that is shown; nothing is drawn where that is all. None: nothing else was
/// chosen.
std::optional<ScanWish> draw_volume_lists(const volumes::ReadReport& report);

}  // namespace trocar::app
