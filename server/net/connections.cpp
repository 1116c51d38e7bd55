#include "server/net/connections.hpp"

#include <utility>
#include <vector>

namespace kinectlab::net {

Connections::Place::Place(Connections& owner, std::string address)
    : owner_(owner), address_(std::move(address)) {
    position_ = owner_.places_.insert(owner_.places_.end(), this);
    ++owner_.by_address_[address_];
}

Connections::Place::~Place() {
    owner_.places_.erase(position_);
    const auto found = owner_.by_address_.find(address_);
    if (--found->second == 0) owner_.by_address_.erase(found);
}

std::unique_ptr<Connections::Place> Connections::admit(const std::string& address) {
    const auto found = by_address_.find(address);
    const std::size_t of_address = found == by_address_.end() ? 0 : found->second;
    if (places_.size() >= total_ || of_address >= per_address_) return nullptr;
    return std::make_unique<Place>(*this, address);
}

void Connections::close_all_soon() {
    // Closing may end a connection at once and change the list.
    std::vector<std::function<void()>> closers;
    for (const Place* place : places_)
        closers.push_back(place->close_soon);
    for (const auto& close : closers) {
        if (close) close();
    }
}

}  // namespace kinectlab::net
