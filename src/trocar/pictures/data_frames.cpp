#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/pictures/data_frames.hpp>
#include <trocar/pictures/npy.hpp>

namespace trocar::pictures {
namespace {

constexpr const char* kKinds[] = {"picture", "depth", "normal", "part", "flow"};

Json list(Vec3d v) { return {v.x, v.y, v.z}; }

std::ofstream opened(const std::filesystem::path& path) {
  std::ofstream out(path);
  if (!out) throw core::EnvironmentLacks(tr("cannot write {}: is the folder writable?", path.string()));
  return out;
}

/// Camera to world, x right, y down, z away from the camera, as computer vision has it: rows of a 4 x 4 matrix.
Json placement_of(const render::Camera& camera) {
  Json rows = Json::array();
  const Vec3f right = camera.rotation.column(0), down = -camera.rotation.column(1), away = -camera.rotation.column(2);
  const Vec3f at = camera.position;
  rows.push_back({right.x, down.x, away.x, at.x});
  rows.push_back({right.y, down.y, away.y, at.y});
  rows.push_back({right.z, down.z, away.z, at.z});
  rows.push_back({0, 0, 0, 1});
  return rows;
}

Json instruments_of(const sim::Model& model, const sim::State& state) {
  Json out = Json::array();
  for (std::size_t h = 0; h < model.hands.size(); ++h) {
    const interactions::ToolState& tool = state.tools[h];
    const interactions::ToolModel& held = model.hands[h].rack[std::size_t(tool.instrument)];
    const interactions::ToolShape shape = sim::shape_of(model, state, h);
    out.push_back({{"hand", model.hands[h].name},
                   {"instrument", held.name},
                   {"tip", list(shape.frame.tip)},
                   {"axis", list(shape.frame.axis())},
                   {"jaw_normal", list(shape.frame.normal())},
                   {"pivot", list(shape.pivot)},
                   {"half_angle", shape.half_angle}});
  }
  return out;
}

}  // namespace

void check_data_rate(double rate) {
  if (rate >= kLeastDataRate && rate <= kMostDataRate) return;
  throw core::BadInput({{{"--data-rate", 0, 0},
                         tr("expected {:g} to {:g} frames a second, got {:g}", kLeastDataRate, kMostDataRate, rate)}});
}

DataFrames::DataFrames(const sim::Model& model, DataOptions options, PictureSize size, const PictureLook& look)
    : m_model(model),
      m_options(std::move(options)),
      m_size(size),
      m_two_eyes(look.eyes),
      m_pictures(model, size, {{}, look.shown}),
      m_period(double(core::kTicksPerSecond) / m_options.rate) {
  if (std::filesystem::exists(m_options.folder / "frames.jsonl"))
    throw core::BadInput(
        {{{m_options.folder.string(), 0, 0}, "expected a folder without frames, got one with frames.jsonl"}});
  if (m_two_eyes.on())
    m_eyes = {{"left", {}}, {"right", {}}};
  else
    m_eyes = {{"", {}}};
  for (const Eye& eye : m_eyes)
    for (const char* kind : kKinds) attempt::make_folder(folder_of(eye, kind));
  m_list = opened(m_options.folder / "frames.jsonl");
  write_about();
}

std::filesystem::path DataFrames::folder_of(const Eye& eye, const char* kind) const {
  return (eye.name.empty() ? m_options.folder : m_options.folder / eye.name) / kind;
}

void DataFrames::write_about() const {
  Json parts = Json::array();
  const std::vector<view::ScenePart>& all = m_pictures.parts();
  for (std::size_t i = 0; i < all.size(); ++i)
    parts.push_back({{"number", i + 1}, {"name", all[i].name}, {"group", name_of(all[i].group)}});
  Json about{{"size", {m_size.width, m_size.height}}, {"rate", m_options.rate}, {"parts", parts}};
  Json eyes = Json::array();
  for (const Eye& eye : m_eyes) eyes.push_back(eye.name);
  about["eyes"] = eyes;
  std::ofstream out = opened(m_options.folder / "about.json");
  out << about.dump(2) << '\n';
}

Json DataFrames::camera_of(const render::Frame& frame) const {
  const render::Projection p(frame.camera, frame.look, m_size.width, m_size.height);
  return {{"focal", p.focal},
          {"centre", {p.centre_x, p.centre_y}},
          {"shift", p.shift},
          {"barrel", p.barrel},
          {"radius", p.radius},
          {"circle", p.circle},
          {"to_world", placement_of(frame.camera)}};
}

void DataFrames::write_layers(const Eye& eye, const std::string& name, const render::Layers& layers) const {
  const auto rows = std::size_t(layers.height), columns = std::size_t(layers.width), n = rows * columns;
  const auto file = [&](const char* kind) { return folder_of(eye, kind) / (name + ".npy"); };
  write_npy(file("depth"), {rows, columns}, layers.depth);
  write_npy(file("normal"), {rows, columns, 3}, std::span<const float>(layers.normal.data()->data(), 3 * n));
  write_npy(file("part"), {rows, columns}, layers.part);
  write_npy(file("flow"), {rows, columns, 2}, std::span<const float>(layers.flow.data()->data(), 2 * n));
}

void DataFrames::add(const sim::State& state, const view::ViewOptions& options) {
  const render::Frame middle = m_pictures.frame(state, options);
  render::Backend& backend = m_pictures.backend();
  std::vector<render::Frame> frames{middle};
  if (m_two_eyes.on()) {
    render::StereoPair pair = eyes_of(m_two_eyes, middle);
    frames = {std::move(pair.left), std::move(pair.right)};
  }
  const std::string name = fmt::format("{:06}", m_count++);
  Json line{{"frame", name}, {"tick", state.tick}, {"seconds", double(state.tick) * sim::kTick}};
  Json cameras = Json::array();
  for (std::size_t e = 0; e < m_eyes.size(); ++e) {
    Eye& eye = m_eyes[e];
    const render::Frame& frame = frames[e];
    draw_frame(backend, frame, render::Target::off_screen(m_size.width, m_size.height));
    render::write_png((folder_of(eye, "picture") / (name + ".png")).string(), backend.read_pixels());
    write_layers(eye, name, backend.draw_layers(frame, eye.before.value_or(frame.camera), m_size.width, m_size.height));
    eye.before = frame.camera;
    cameras.push_back(camera_of(frame));
  }
  backend.remember(middle);
  line["cameras"] = cameras;
  line["instruments"] = instruments_of(m_model, state);
  m_list << line.dump() << std::endl;  // flushed: what is there stays
  if (!m_list) throw core::EnvironmentLacks(tr("cannot write {}: is the disk full?", m_options.folder.string()));
  while (due(state.tick)) m_next += m_period;
}

Json DataFrames::finish() { return {{"folder", m_options.folder.string()}, {"frames", m_count}}; }

}  // namespace trocar::pictures
