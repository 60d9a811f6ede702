#include "peers/peer.h"

namespace accrete::bench {

std::unique_ptr<Peer> opencv(const cli::BenchPool&) { return nullptr; }

}  // namespace accrete::bench
