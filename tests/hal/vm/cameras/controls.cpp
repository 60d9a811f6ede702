#include "controls.h"

namespace accrete::vm {

bool Controls::answer(std::uint8_t entity, std::uint8_t selector, Ask ask, std::span<const std::uint8_t> given,
                      Bytes& reply) {
  for (Control& c : controls_) {
    if (c.entity != entity || c.selector != selector) continue;
    switch (ask) {
      case Ask::kSetCurrent:
        c.current = 0;
        for (std::size_t i = given.size(); i-- > 0;) c.current = c.current << 8 | given[i];
        return true;
      case Ask::kCurrent:
        put(reply, c.current, c.bytes);
        return true;
      case Ask::kLeast:
        put(reply, c.least, c.bytes);
        return true;
      case Ask::kMost:
        put(reply, c.most, c.bytes);
        return true;
      case Ask::kStep:
        put(reply, c.step, c.bytes);
        return true;
      case Ask::kDefault:
        put(reply, c.initial, c.bytes);
        return true;
      case Ask::kLength:
        put(reply, static_cast<std::uint32_t>(c.bytes), 2);
        return true;
      case Ask::kInfo:
        put(reply, 3, 1);  // can be read and set
        return true;
    }
  }
  return false;
}

}  // namespace accrete::vm
