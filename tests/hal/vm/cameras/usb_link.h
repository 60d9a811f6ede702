// A USB device's end of the USB/IP protocol (the kernel's Documentation/usb/usbip_protocol.rst): the kernel's vhci_hcd
// holds the other end of a socket pair and makes a host controller of it. Requests come, answers go; no network is
// involved.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace accrete::vm {

struct UsbRequest {
  bool unlink = false;         // give up request `unlinked`
  std::uint32_t sequence = 0;  // names the request in the answer
  std::uint32_t unlinked = 0;
  std::uint32_t endpoint = 0;
  bool in = false;  // towards the host
  std::uint32_t length = 0;
  std::array<std::uint8_t, 8> setup{};
  std::vector<std::uint8_t> data;  // from the host
};

class UsbLink {
 public:
  // Plugs a high-speed device into a port of vhci_hcd. Throws std::system_error.
  explicit UsbLink(int port);
  ~UsbLink();  // pulls it out
  UsbLink(const UsbLink&) = delete;
  UsbLink& operator=(const UsbLink&) = delete;

  [[nodiscard]] int descriptor() const { return socket_; }
  // Waits for the next request. False: the controller is gone.
  [[nodiscard]] bool receive(UsbRequest& request);
  // Answers; the data of an answer to the host are a header and the rest. False: the controller is gone.
  bool send_data(std::uint32_t sequence, std::span<const std::uint8_t> header, std::span<const std::uint8_t> rest = {});
  bool accept_data(std::uint32_t sequence, std::uint32_t length);  // of a request from the host
  bool refuse(std::uint32_t sequence);                             // a stall
  bool confirm_unlink(std::uint32_t sequence, bool was_pending);

 private:
  bool answer(std::uint32_t command, std::uint32_t sequence, int status, std::uint32_t length,
              std::span<const std::uint8_t> header, std::span<const std::uint8_t> rest);

  int socket_ = -1;
  std::vector<std::uint8_t> message_;
};

}  // namespace accrete::vm
