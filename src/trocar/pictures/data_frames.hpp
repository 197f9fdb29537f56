// Frames for researchers: pictures with depth, normals, part numbers, flow and cameras, from a run without a window.
// docs/guides/data_frames.md describes the files.
//
//   DataFrames data(model, {"data", 5}, {800, 600}, look);
//   ... each tick:  if (data.due(state.tick)) data.add(state, view_options);
//   left["data"] = data.finish();
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>

#include <trocar/pictures/pictures.hpp>

namespace trocar::pictures {

inline constexpr const char* kDataHelp =
    "write frames for research to this folder: pictures, depth, normals, part numbers, optical flow, cameras";
inline constexpr double kDataRate = 5, kLeastDataRate = 0.01, kMostDataRate = 1000;  ///< [1/s]

struct DataOptions {
  std::filesystem::path folder;  ///< empty: none
  double rate = kDataRate;       ///< frames per simulated second
};
/// @throws core::BadInput where it is not a rate
void check_data_rate(double rate);

class DataFrames {
 public:
  /// Makes the folder and its own pictures.  @throws core::EnvironmentLacks, core::BadInput where there are frames
  DataFrames(const sim::Model& model, DataOptions options, PictureSize size, const PictureLook& look);

  bool due(std::uint64_t tick) const { return double(tick) >= m_next; }
  void add(const sim::State& state, const view::ViewOptions& options);
  /// The result's words on them.
  Json finish();

 private:
  struct Eye {
    std::string name;  ///< of its folder; empty: there is one eye
    std::optional<render::Camera> before;
  };
  void write_about() const;
  void write_layers(const Eye& eye, const std::string& name, const render::Layers& layers) const;
  std::filesystem::path folder_of(const Eye& eye, const char* kind) const;
  Json camera_of(const render::Frame& frame) const;

  const sim::Model& m_model;
  DataOptions m_options;
  PictureSize m_size;
  TwoEyes m_two_eyes;
  Pictures m_pictures;
  std::vector<Eye> m_eyes;
  std::ofstream m_list;  ///< frames.jsonl, a line a frame: what was written stays, whatever happens
  double m_next = 0, m_period;
  int m_count = 0;
};

}  // namespace trocar::pictures
