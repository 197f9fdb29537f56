#include "modeller/builder.hpp"

#include <chrono>
#include <utility>

namespace trocar::app {
namespace {

constexpr std::uint64_t kStandingTicks = 500;

std::unique_ptr<BuiltDocument> made(const modeller::Document& document) {
  auto out = std::make_unique<BuiltDocument>();
  out->built = modeller::build(document);
  out->read_outs = modeller::read_outs(out->built, kStandingTicks);
  return out;
}

}  // namespace

void Builder::want(const modeller::Document& document) {
  if (m_asked == document.version()) return;
  m_asked = document.version();
  if (m_running.valid())
    m_next = document;
  else
    m_running = std::async(std::launch::async, [copy = document] { return made(copy); });
}

std::unique_ptr<BuiltDocument> Builder::poll() {
  if (!m_running.valid() || m_running.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return nullptr;
  std::unique_ptr<BuiltDocument> out = m_running.get();
  if (std::exchange(m_unwanted, false)) out.reset();
  if (m_next) {
    m_running = std::async(std::launch::async, [copy = std::move(*m_next)] { return made(copy); });
    m_next.reset();
  }
  return out;
}

void Builder::forget() {
  m_asked = ~0ull;
  m_next.reset();
  m_unwanted = m_running.valid();
}

}  // namespace trocar::app
