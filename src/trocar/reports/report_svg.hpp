// The report's drawings: SVG text with classes instead of colours, so that one style sheet serves screen, dark screen
// and paper. Every drawing carries a title and a description for those who do not see it.
#pragma once

#include <string>
#include <vector>

namespace trocar::reports {

/// 1, 2 or 5 times a power of ten, such that about `wanted` of them fit.
double tick_step(double length, int wanted);

struct Series {
  std::string name;
  std::vector<double> x, y;  ///< NaN interrupts the line
  int style = 0;             ///< 0..5: a colour and a dash
};
struct Level {
  double y = 0;
  std::string name;
};
struct PlotMark {
  double x = 0;
  std::string name;
  bool bad = false;
};

/// Lines over a common x.
struct Plot {
  std::string id;                  ///< unique on the page
  std::string title, description;  ///< read out
  std::string x_label, y_label;
  std::vector<Series> series;
  std::vector<Level> levels;  ///< thresholds
  std::vector<PlotMark> marks;
  double x_from = 0, x_to = 0;  ///< both 0: as the data are
  double y_from = 0, y_to = 0;  ///< both 0: from 0, or the data's minimum, to the data's maximum
  bool points = false;          ///< a dot at every value: few values
  bool whole_x = false;         ///< x counts something
  int emphasised = -1;          ///< with points: this one is ringed
  int width = 760, height = 200;
};
std::string svg(const Plot& plot);
/// What the series' styles mean, as one line of HTML.
std::string legend(const std::vector<Series>& series);

/// Steps as bars in lanes, errors and events as marks below them.
struct TimelineBar {
  std::string lane, name;
  double from = 0, to = 0;
};
struct Timeline {
  std::vector<TimelineBar> bars;
  std::vector<PlotMark> errors, events;
  double length = 0;       ///< [s]
  double clock_from = -1;  ///< when the exercise's clock began; below 0: not at all [s]
};
std::string svg(const Timeline& timeline);

/// A curve seen along an axis. Coordinates to the right and up [mm].
struct Projection {
  std::string id, title, description, right, up;
  std::vector<Series> paths;
  double low[2]{}, high[2]{};  ///< what is shown
};
std::string svg(const Projection& projection);

/// The fewest points that draw the same line on so many columns: of each column first, lowest, highest and last.
Series thinned(const Series& series, int columns);

/// "4:07"
std::string minutes(double seconds);

}  // namespace trocar::reports
