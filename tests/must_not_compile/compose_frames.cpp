// Composing transforms whose neighbouring frames differ does not compile.
// expect: no match for 'operator*'|invalid operands
#include "accrete/geometry.h"

using namespace accrete;

int main() {
  const Transform<Left, Object> T_l_o;
  const Transform<World, Left> T_w_l;
#ifdef BROKEN
  const Transform<World, Object> T_w_o = T_l_o * T_w_l;
#else
  const Transform<World, Object> T_w_o = T_w_l * T_l_o;
#endif
  return T_w_o.translation[0] > 0 ? 1 : 0;
}
