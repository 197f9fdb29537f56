// Draws nothing: what CheckedBackend refuses and counts is all there is to test against.
#include <trocar/render/backend/checked_backend.hpp>

namespace trocar::render {

namespace {

class NullBackend final : public CheckedBackend {
  void on_store(std::uint32_t, const MeshArrays&) override {}
  void on_update(std::uint32_t, std::span<const Vec3f>, std::span<const Vec3f>, std::span<const Paint>) override {}
  void on_destroy(std::uint32_t) override {}
  void on_prepare(std::span<const DrawItem>) override {}
  void on_prepare_liquids() override {}
  void on_frame(const Frame&, const Target&, std::span<const DrawItem* const>,
                std::span<const DrawItem* const>) override {}
  void on_keep_eye(Eye, const Target&) override {}
  void on_combine(StereoMode, const Target&) override {}
  RawLayers on_layers(const Frame&, std::span<const DrawItem* const>, const Camera&, int, int) override { return {}; }
  void on_remember(std::span<const DrawItem* const>) override {}
  Image on_read(const Target& target) override {
    return {target.width, target.height, std::vector<std::uint8_t>(std::size_t(3) * target.width * target.height)};
  }
};

}  // namespace

std::unique_ptr<Backend> make_null_backend() { return std::make_unique<NullBackend>(); }

}  // namespace trocar::render
