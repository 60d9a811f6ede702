// The cameras' control socket, for the tests. An order is one line, answered with "ok" once it is in force:
//   show N        the reader paces: picture N at once, and again at every period
//   run           one picture a period, from picture 0 on
//   drop C N, cut C N, flag C N   the next N frames of camera C are not sent, sent by half, flagged as erroneous
//   still C MS    camera C sends nothing for that long
//   late C MS     every frame of camera C, from now on
//   unplug C, plug C
#pragma once

#include <string>

namespace accrete::vm {

inline constexpr const char* kOrderSocket = "/run/accrete-cameras";

// Throws std::system_error (no cameras) or std::runtime_error (not understood).
void order(const std::string& line);

}  // namespace accrete::vm
