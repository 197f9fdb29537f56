#include <cstdio>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/picture_size.hpp>

namespace trocar::pictures {

PictureSize parse_size(const std::string& text) {
  PictureSize size;
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &rest);
  const auto good = [](int n) { return n >= 64 && n <= 8192; };
  if (read != 2 || !good(size.width) || !good(size.height))
    throw core::BadInput({{{"--size", 0, 0}, tr("expected WIDTHxHEIGHT, each 64 to 8192, got '{}'", text)}});
  return size;
}

}  // namespace trocar::pictures
