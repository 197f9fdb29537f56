// trocar bench --picture: what pictures of an operation cost, pass by pass, without a window.
#pragma once

#include <optional>
#include <string>

#include <trocar/core/json.hpp>
#include <trocar/pictures/picture_size.hpp>

namespace trocar::app {

struct PictureBench {
  pictures::PictureSize size;
  int frames = 32;           ///< a figure is the median of so many
  std::optional<double> at;  ///< of which moment [s]; nothing: the one whose picture costs most
};

/// @param seconds  of the operation, simulated, at most
/// @throws core::EnvironmentLacks without OpenGL
Json bench_picture(const std::string& exercise, double seconds, const PictureBench& options);

/// Its tables, for people.
void print_picture_bench(const Json& result);

}  // namespace trocar::app
