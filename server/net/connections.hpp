#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>

namespace kinectlab::net {

/// Who is connected, within bounds. Lives on the I/O thread, so it needs no lock.
class Connections {
public:
    Connections(std::size_t total, std::size_t per_address)
        : total_(total), per_address_(per_address) {}

    /// A place among the connections, given back by the destructor.
    class Place {
    public:
        Place(Connections& owner, std::string address);
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;
        ~Place();

        /// What ends this connection politely; replaced when a request becomes a WebSocket.
        std::function<void()> close_soon;

    private:
        Connections& owner_;
        std::string address_;
        std::list<Place*>::iterator position_;
    };

    /// Nothing if there are too many connections, or too many of that address.
    [[nodiscard]] std::unique_ptr<Place> admit(const std::string& address);

    [[nodiscard]] std::size_t count() const { return places_.size(); }
    void close_all_soon();

private:
    std::size_t total_;
    std::size_t per_address_;
    std::list<Place*> places_;
    std::map<std::string, std::size_t> by_address_;
};

}  // namespace kinectlab::net
