#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "pipeline/drivers/simulated_rig/device.hpp"
#include "pipeline/drivers/simulated_rig/device_uri.hpp"
#include "pipeline/drivers/simulated_rig/openni_driver.hpp"
#include "pipeline/drivers/simulated_rig/plugs.hpp"

namespace kinectlab::simulated_rig {
namespace {

OniDeviceInfo device_info(const std::string& uri) {
    OniDeviceInfo info{};
    const auto write = [](char(&field)[ONI_MAX_STR], std::string_view text) {
        std::copy_n(text.begin(), std::min<std::size_t>(text.size(), ONI_MAX_STR - 1), field);
    };
    write(info.uri, uri);
    write(info.vendor, "Kinectlab");
    write(info.name, "Simulated pendulum rig");
    return info;
}

/// Lists "sim://pendulum", and any other rig from when a program first names it.
class Driver : public oni::driver::DriverBase {
public:
    explicit Driver(OniDriverServices* services) : DriverBase(services) {}

    OniStatus initialize(
        oni::driver::DeviceConnectedCallback connected,
        oni::driver::DeviceDisconnectedCallback disconnected,
        oni::driver::DeviceStateChangedCallback state_changed,
        void* cookie
    ) override {
        const OniStatus status =
            DriverBase::initialize(connected, disconnected, state_changed, cookie);
        if (status != ONI_STATUS_OK) return status;
        plugs_.emplace([this](const std::string& uri, bool in) {
            in ? deviceConnected(info_of(uri)) : deviceDisconnected(info_of(uri));
        });
        deviceConnected(info_of(std::string(kDefaultUri)));
        return ONI_STATUS_OK;
    }

    OniStatus tryDevice(const char* uri) override {
        if (const auto settings = parse_uri(uri); !settings) {
            if (settings.error().code != ErrorCode::not_found)
                getServices().errorLoggerAppend("%s", to_text(settings.error()).c_str());
            return ONI_STATUS_ERROR;
        }
        if (std::string_view(uri).size() >= ONI_MAX_STR) return ONI_STATUS_ERROR;
        deviceConnected(info_of(uri));
        return ONI_STATUS_OK;
    }

    oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override try {
        auto settings = parse_uri(uri);
        if (!settings) return nullptr;
        settings->with_colour = false;  // until a program creates the stream
        return new Device(uri, *settings, [this, name = std::string(uri)](double seconds) {
            plugs_->pull(name, std::chrono::duration<double>(seconds));
        });
    } catch (const std::exception& error) {
        getServices().errorLoggerAppend("%s: %s", uri, error.what());
        return nullptr;
    }

    void deviceClose(oni::driver::DeviceBase* device) override { delete device; }

    void shutdown() override { plugs_.reset(); }

    /// Depth and colour are captured together always; the group needs no more than a name.
    void* enableFrameSync(oni::driver::StreamBase** /*streams*/, int /*count*/) override {
        return this;
    }
    void disableFrameSync(void* /*group*/) override {}

private:
    /// OpenNI2 keeps the address: entries stay where they are, for good.
    const OniDeviceInfo* info_of(const std::string& uri) {
        const std::lock_guard lock(infos_mutex_);
        return &infos_.try_emplace(uri, device_info(uri)).first->second;
    }

    std::mutex infos_mutex_;
    std::map<std::string, OniDeviceInfo> infos_;
    std::optional<Plugs> plugs_;
};

}  // namespace
}  // namespace kinectlab::simulated_rig

ONI_EXPORT_DRIVER(kinectlab::simulated_rig::Driver)
