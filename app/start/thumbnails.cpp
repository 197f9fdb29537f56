#include "start/thumbnails.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/log.hpp>

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

constexpr int kMostAtOnce = 4;  // files that are read between two pictures of the window

unsigned texture_of(const render::Image& image) {
  unsigned texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

std::uint64_t hash_of_file(const fs::path& file, std::uint64_t seed) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return core::hash_bytes(text.data(), text.size(), seed);
}

}  // namespace

fs::path thumbnail_file(const attempt::ExerciseEntry& e) {
  std::string name = e.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '.';
  const std::uint64_t hash = hash_of_file(e.path, e.task ? hash_of_file(e.scene, 0) : 0);
  return attempt::data_folder() / "thumbnails" / fmt::format("{}-{:016x}.png", name, hash);
}

Thumbnails::~Thumbnails() {
  if (m_maker) m_maker->ask_to_end();
  for (const auto& [name, picture] : m_pictures)
    if (picture.texture != 0) glDeleteTextures(1, &picture.texture);
}

Thumbnails::Picture& Thumbnails::picture_of(const attempt::ExerciseEntry& exercise) {
  const auto [it, fresh] = m_pictures.try_emplace(exercise.name);
  if (fresh) {
    it->second.file = thumbnail_file(exercise);
    load(it->second);
  }
  return it->second;
}

void Thumbnails::load(Picture& picture) {
  std::error_code error;
  if (picture.texture != 0 || !fs::exists(picture.file, error)) return;
  try {
    picture.texture = texture_of(render::read_png(picture.file.string()));
  } catch (const core::BadInput&) {  // half written by a program that was ended: it is made again
    fs::remove(picture.file, error);
  }
}

unsigned Thumbnails::of(const attempt::ExerciseEntry& exercise) {
  if (m_pictures.count(exercise.name) == 0 && ++m_looked_up > kMostAtOnce) return 0;
  Picture& picture = picture_of(exercise);
  if (picture.texture == 0 && !picture.asked && !picture.failed) {
    picture.asked = true;
    m_wanted.push_back(exercise.name);
  }
  return picture.texture;
}

void Thumbnails::work(bool may) {
  m_looked_up = 0;
  if (m_maker) {
    if (m_maker->running()) return;
    Picture& made = m_pictures[m_being_made];
    load(made);
    made.failed = made.texture == 0;
    if (made.failed) core::log::info("no thumbnail of {}: {}", m_being_made, m_maker->errors());
    m_maker.reset();
    return;
  }
  while (may && !m_wanted.empty()) {
    m_being_made = m_wanted.front();
    m_wanted.pop_front();
    const Picture& picture = m_pictures[m_being_made];
    if (picture.texture != 0 || picture.failed) continue;
    try {
      m_maker.emplace(std::vector<std::string>{"thumbnail", m_being_made, picture.file.string()});
    } catch (const core::EnvironmentLacks& lacks) {
      core::log::info("no thumbnails: {}", lacks.what());
      m_wanted.clear();
    }
    return;
  }
}

void Thumbnails::keep(const attempt::ExerciseEntry& exercise, const render::Image& image) {
  Picture& picture = picture_of(exercise);
  if (picture.texture != 0) return;
  picture.texture = texture_of(image);
  try {
    attempt::make_folder(picture.file.parent_path());
    render::write_png(picture.file.string(), image);
  } catch (const core::EnvironmentLacks& lacks) {
    core::log::info("the thumbnail is not kept: {}", lacks.what());
  }
}

}  // namespace trocar::app
