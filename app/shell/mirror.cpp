#include "shell/mirror.hpp"

#include "shell/pane_canvas.hpp"

namespace trocar::app {

void mirror(const render::Target& part) {
  static PaneCanvas copy;  // as large as the last picture, as long as the program
  copy.copy(part);
  copy.lay(part, true);
}

}  // namespace trocar::app
