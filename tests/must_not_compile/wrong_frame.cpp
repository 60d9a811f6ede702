// A transform of other frames cannot be handed over as if it were the right one.
// expect: Transform
// expect: cannot convert|no known conversion|no viable conversion
#include "accrete/motion.h"

using namespace accrete;

int main() {
  const Transform<Left, Object> T_l_o;
#ifdef BROKEN
  const Motion motion = Motion::object({}, T_l_o.inverse());
#else
  const Motion motion = Motion::object({}, T_l_o);
#endif
  return motion.t.ns > 0 ? 1 : 0;
}
