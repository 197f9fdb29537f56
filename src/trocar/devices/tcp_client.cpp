#include <cerrno>
#include <cstring>

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/devices/tcp_client.hpp>

namespace trocar::devices {

int connect_tcp(const std::string& address, int port, std::string& why) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int fault = getaddrinfo(address.c_str(), std::to_string(port).c_str(), &wanted, &found); fault != 0) {
    why = gai_strerror(fault);
    return -1;
  }
  int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval limit{2, 0};
  if (socket >= 0) setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);  // of connect(), too
  if (socket < 0 || connect(socket, found->ai_addr, found->ai_addrlen) != 0) {
    why = std::strerror(errno);
    if (socket >= 0) close(socket);
    socket = -1;
  }
  freeaddrinfo(found);
  return socket;
}

}  // namespace trocar::devices
