#include "orders.h"

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace accrete::vm {

void order(const std::string& line) {
  const int s = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const timeval limit{5, 0};
  setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  sockaddr_un address{AF_UNIX, {}};
  std::array<char, 64> reply{};
  // An empty name lets the kernel choose one, to which the answer can be sent.
  bool done = bind(s, reinterpret_cast<sockaddr*>(&address), sizeof address.sun_family) == 0;
  std::strncpy(address.sun_path, kOrderSocket, sizeof address.sun_path - 1);
  done = done && connect(s, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
         send(s, line.data(), line.size(), 0) >= 0 && recv(s, reply.data(), reply.size() - 1, 0) >= 0;
  const int error = errno;
  close(s);
  if (!done) throw std::system_error(error, std::generic_category(), kOrderSocket);
  if (std::string_view(reply.data()) != "ok") throw std::runtime_error("the cameras do not understand: " + line);
}

}  // namespace accrete::vm
