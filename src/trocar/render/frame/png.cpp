// The only place where stb's implementation is compiled.
#include <cstring>

#include <trocar/core/error.hpp>
#include <trocar/render/frame/image.hpp>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wcast-qual"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace trocar::render {

void write_png(const std::string& path, const Image& image) {
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != std::size_t(3) * image.width * image.height)
    throw std::invalid_argument("write_png: picture is empty or its size does not match its data");
  if (!stbi_write_png(path.c_str(), image.width, image.height, 3, image.rgb.data(), 3 * image.width))
    throw core::EnvironmentLacks(path + ": cannot write the picture; is the folder there and writable?");
}

Image read_png(const std::string& path) {
  Image image;
  int channels = 0;
  stbi_uc* data = stbi_load(path.c_str(), &image.width, &image.height, &channels, 3);
  if (!data) {
    core::Fault fault;
    fault.at.file = path;
    fault.message = std::string("expected a PNG picture, got: ") + stbi_failure_reason();
    throw core::BadInput({fault});
  }
  image.rgb.assign(data, data + std::size_t(3) * image.width * image.height);
  stbi_image_free(data);
  return image;
}

}  // namespace trocar::render
