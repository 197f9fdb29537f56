// A room in a window of its own beside the trainer: its arms carry the instruments as the hands of the attempt move
// them.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include <trocar/sim/model/state.hpp>
#include <trocar/studies/operating_room/room_model.hpp>
#include <trocar/view/operating_room/room_drawing.hpp>

#include "shell/pane_canvas.hpp"
#include "shell/second_window.hpp"

namespace trocar::app {

/// A path, or a name under a folder of scenes/.
std::filesystem::path room_path(const std::string& name, const char* folder);
/// @throws core::BadInput
std::unique_ptr<studies::RoomModel> load_room(const std::string& name);

class RoomBeside {
 public:
  /// @throws core::BadInput, core::EnvironmentLacks
  RoomBeside(Window& main, render::Backend& backend, const std::string& room);
  ~RoomBeside();

  /// At most ten times a second, and a tenth of the time; not after somebody closed it.
  void show(const sim::Model& model, const sim::State& state);

 private:
  void follow(const sim::Model& model, const sim::State& state);

  render::Backend& m_backend;
  std::unique_ptr<studies::RoomModel> m_room;
  studies::RoomPose m_pose;
  std::unique_ptr<view::RoomDrawing> m_drawing;
  PaneCanvas m_canvas;
  std::unique_ptr<SecondWindow> m_window;
  std::chrono::steady_clock::time_point m_next{};
};

}  // namespace trocar::app
