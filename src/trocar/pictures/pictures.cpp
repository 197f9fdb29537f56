#include <algorithm>
#include <cctype>
#include <fstream>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/pictures.hpp>
#include <trocar/render/gl/gl_context.hpp>

namespace trocar::pictures {

Pictures::Pictures(const sim::Model& model, PictureSize size, const PictureLook& look)
    : m_size(size),
      m_eyes(look.eyes),
      m_context(render::GlContext::off_screen()),
      m_backend(render::make_gl_backend(*m_context)),
      m_view(std::make_unique<view::SceneView>(model, *m_backend)),
      m_styles(styles_of(look.shown, m_view->parts())),
      m_analysis(look.analysis) {}

Pictures::~Pictures() = default;

const std::string& Pictures::driver() const { return m_context->description(); }

/// What was asked for of all pictures, where this one has no wishes of its own.
void Pictures::choose(view::ViewOptions& options) const {
  if (options.styles.empty()) options.styles = m_styles;
  if (!options.analysis.on()) options.analysis = m_analysis;
  options.picture_height = m_size.height;
}

/// What was drawn, with its legend.
render::Image Pictures::read(const view::ViewOptions& options) {
  render::Image image = m_backend->read_pixels();
  if (options.analysis.on()) m_legend.paint(legend_of(options.analysis), image);
  return image;
}

render::Frame Pictures::frame(const sim::State& state, view::ViewOptions options) {
  m_context->make_current();  // others may have drawn in between
  choose(options);
  return m_view->frame(state, options);
}

render::Image Pictures::draw(const sim::State& state, view::ViewOptions options) {
  choose(options);
  const render::Frame frame = this->frame(state, options);
  draw_for(m_eyes, *m_backend, frame, render::Target::off_screen(m_size.width, m_size.height));
  return read(options);
}

render::Image Pictures::still(const sim::State& state, view::ViewOptions options) {
  // The exposure follows the brightness that it measured in the picture before, by simulated time: pretend seconds.
  constexpr int kSettling = 3;
  choose(options);
  options.eye_index = 7;  // an exposure memory of its own
  render::Frame frame = this->frame(state, options);
  for (int i = 0; i <= kSettling; ++i) {
    frame.tick = state.tick + std::uint64_t(i) * 2000;
    frame.quality.samples = i == kSettling ? 4 : 1;
    draw_for(m_eyes, *m_backend, frame, render::Target::off_screen(m_size.width, m_size.height));
  }
  return read(options);
}

Shots::Shots(Pictures& pictures, const std::filesystem::path& folder, std::string only)
    : m_pictures(pictures), m_folder(folder), m_only(std::move(only)) {
  attempt::make_folder(folder);
}

namespace {

std::string file_part(std::string text) {
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '-';
  return text;
}

}  // namespace

bool Shots::skips(const std::string& what) {
  const bool full = int(m_files.size()) >= kMaxShots;
  if (wants(what) && !full) return false;
  if (full)
    ++m_left_out;
  else
    ++m_next;
  return true;
}

void Shots::take(const sim::State& state, const std::string& what, const std::string& text) {
  take_outside(state, what, text, {});
}

void Shots::take_outside(const sim::State& state, const std::string& what, const std::string& text,
                         const view::ViewOptions& options) {
  if (!skips(what)) write(state, what, text, m_pictures.still(state, options));
}

void Shots::take_image(const sim::State& state, const std::string& what, const std::string& text,
                       const render::Image& image) {
  if (!skips(what)) write(state, what, text, image);
}

void Shots::write(const sim::State& state, const std::string& what, const std::string& text,
                  const render::Image& image) {
  const std::string name = fmt::format("{:03}-{}.png", m_next++, file_part(what));
  const std::string path = (m_folder / name).string();
  render::write_png(path, image);
  m_files.push_back(path);
  m_index.push_back({{"file", name}, {"seconds", double(state.tick) * sim::kTick}, {"shows", text}});
}

void Shots::write_index() const {
  std::ofstream out(index_file());
  out << Json{{"pictures", m_index}, {"left_out", m_left_out}}.dump(2) << '\n';
  if (!out.flush()) throw core::EnvironmentLacks(tr("cannot write {}: is the disk full?", index_file()));
}

}  // namespace trocar::pictures
