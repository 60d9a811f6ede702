// A status must not be dropped.
// expect: nodiscard
#pragma GCC diagnostic error "-Wunused-result"
#include "accrete/camera.h"

int main() {
  const accrete::Camera camera;
#ifdef BROKEN
  accrete::validate(camera);
#else
  return accrete::validate(camera) == accrete::Status::kOk ? 0 : 1;
#endif
}
