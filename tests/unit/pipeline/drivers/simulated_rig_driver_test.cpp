// The simulated rig as any OpenNI2 program sees it: nothing here but OpenNI2's own interface.
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include <OpenNI.h>
#include <gtest/gtest.h>

#include "pipeline/drivers/simulated_rig/protocol.hpp"

namespace kinectlab::simulated_rig {
namespace {

using namespace std::chrono_literals;

class SimulatedRigDriver : public testing::Test {
protected:
    static void SetUpTestSuite() {
        ASSERT_EQ(openni::OpenNI::initialize(), openni::STATUS_OK)
            << openni::OpenNI::getExtendedError();
    }
    static void TearDownTestSuite() { openni::OpenNI::shutdown(); }

    static bool listed(const std::string& uri) {
        openni::Array<openni::DeviceInfo> devices;
        openni::OpenNI::enumerateDevices(&devices);
        for (int i = 0; i < devices.getSize(); ++i)
            if (devices[i].getUri() == uri) return true;
        return false;
    }
};

/// Waits for a condition that real time brings about; false after a while much longer than it
/// takes.
template <class Condition>
bool eventually(Condition condition) {
    const auto deadline = std::chrono::steady_clock::now() + 30s;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > deadline) return false;
        std::this_thread::sleep_for(5ms);
    }
    return true;
}

RigState state_of(const openni::Device& device) {
    RigState state;
    int size = sizeof(state);
    EXPECT_EQ(device.getProperty(kState, &state, &size), openni::STATUS_OK);
    return state;
}

openni::Status command(openni::Device& device, Action action, double value = 0.0) {
    return device.setProperty(kActuator, ActuatorCommand{action, 0, value});
}

openni::Status make(openni::Device& device, const std::string& apparatus) {
    return device.setProperty(kApparatus, apparatus.data(), static_cast<int>(apparatus.size()));
}

std::string apparatus_of(const openni::Device& device) {
    std::string text(kLongestApparatus, '\0');
    int size = kLongestApparatus;
    EXPECT_EQ(device.getProperty(kApparatus, text.data(), &size), openni::STATUS_OK);
    return text.c_str();
}

TEST_F(SimulatedRigDriver, IsListed) {
    EXPECT_TRUE(listed("sim://pendulum"));
}

TEST_F(SimulatedRigDriver, StreamsDepthAndColourInTime) {
    openni::Device device;
    ASSERT_EQ(device.open("sim://streams?seed=5"), openni::STATUS_OK);
    openni::VideoStream depth;
    openni::VideoStream colour;
    ASSERT_EQ(depth.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
    ASSERT_EQ(colour.create(device, openni::SENSOR_COLOR), openni::STATUS_OK);
    EXPECT_EQ(depth.getVideoMode().getPixelFormat(), openni::PIXEL_FORMAT_DEPTH_1_MM);
    EXPECT_EQ(colour.getVideoMode().getPixelFormat(), openni::PIXEL_FORMAT_RGB888);
    EXPECT_EQ(depth.getMaxPixelValue(), 10000);
    EXPECT_FALSE(depth.getMirroringEnabled());
    EXPECT_NEAR(depth.getHorizontalFieldOfView(), 2.0 * std::atan(320.0 / 580.0), 1e-6);
    EXPECT_TRUE(device.isImageRegistrationModeSupported(openni::IMAGE_REGISTRATION_OFF));
    EXPECT_FALSE(device.isImageRegistrationModeSupported(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR)
    );
    ASSERT_EQ(depth.start(), openni::STATUS_OK);
    ASSERT_EQ(colour.start(), openni::STATUS_OK);
    for (openni::VideoStream* stream : {&depth, &colour}) {
        int last = 0;
        for (int i = 0; i < 10; ++i) {
            openni::VideoFrameRef frame;
            ASSERT_EQ(stream->readFrame(&frame), openni::STATUS_OK);
            EXPECT_EQ(frame.getWidth(), 640);
            EXPECT_EQ(frame.getHeight(), 480);
            EXPECT_EQ(frame.getDataSize(), 640 * 480 * (stream == &depth ? 2 : 3));
            EXPECT_GT(frame.getFrameIndex(), last);
            last = frame.getFrameIndex();
            EXPECT_NEAR(static_cast<double>(frame.getTimestamp()), last * 1e6 / 30.0, 0.51);
        }
    }
}

TEST_F(SimulatedRigDriver, PairsFramesWhenAskedTo) {
    openni::Device device;
    ASSERT_EQ(device.open("sim://paired"), openni::STATUS_OK);
    EXPECT_EQ(device.setDepthColorSyncEnabled(true), openni::STATUS_OK);
}

TEST_F(SimulatedRigDriver, ShowsTheBobWhereItIs) {
    openni::Device device;
    ASSERT_EQ(device.open("sim://truth?noise=none&seed=1"), openni::STATUS_OK);
    CameraGeometry geometry{};
    int size = sizeof(geometry);
    ASSERT_EQ(device.getProperty(kGeometry, &geometry, &size), openni::STATUS_OK);
    openni::VideoStream depth;
    ASSERT_EQ(depth.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
    ASSERT_EQ(depth.start(), openni::STATUS_OK);

    ASSERT_EQ(command(device, Action::displace, 0.3), openni::STATUS_OK);
    ASSERT_TRUE(eventually([&] { return state_of(device).motion == Motion::held; }));
    const RigState held = state_of(device);
    EXPECT_NEAR(held.bodies[0].p_lab_m[0], std::sin(0.3), 1e-9);

    openni::VideoFrameRef frame;
    do {
        ASSERT_EQ(depth.readFrame(&frame), openni::STATUS_OK);
    } while (static_cast<double>(frame.getTimestamp()) * 1e-6 < held.device_time_s);
    // The camera is level and looks along +y: x_cam = x, y_cam = height - z, z_cam = distance + y.
    const double x = held.bodies[0].p_lab_m[0] - geometry.T_lab_cam[3];
    const double z = held.bodies[0].p_lab_m[1] - geometry.T_lab_cam[7];
    const double y = geometry.T_lab_cam[11] - held.bodies[0].p_lab_m[2];
    const auto u = static_cast<int>(std::lround(geometry.depth_fx * x / z + geometry.depth_cx));
    const auto v = static_cast<int>(std::lround(geometry.depth_fy * y / z + geometry.depth_cy));
    const auto* pixels = static_cast<const std::uint16_t*>(frame.getData());
    const double measured = 1e-3 * pixels[v * 640 + u];
    const double off = std::hypot(
        (u - geometry.depth_cx) / geometry.depth_fx * measured - x,
        (v - geometry.depth_cy) / geometry.depth_fy * measured - y,
        measured - z
    );
    EXPECT_NEAR(off, 0.05, 1e-3);

    ASSERT_EQ(command(device, Action::release), openni::STATUS_OK);
    ASSERT_TRUE(eventually([&] { return state_of(device).motion == Motion::free; }));
    ASSERT_TRUE(eventually([&] { return state_of(device).bodies[0].p_lab_m[0] < -0.1; }));
    ASSERT_EQ(command(device, Action::stop), openni::STATUS_OK);
    ASSERT_TRUE(eventually([&] { return state_of(device).motion == Motion::at_rest; }));
}

TEST_F(SimulatedRigDriver, TakesOverAnotherPendulum) {
    openni::Device device;
    ASSERT_EQ(device.open("sim://other?noise=none"), openni::STATUS_OK);
    ASSERT_EQ(make(device, "pendulum length_m=1.5"), openni::STATUS_OK);
    EXPECT_EQ(apparatus_of(device), "pendulum length_m=1.5");
    EXPECT_EQ(make(device, "pendulum length_m=-1"), openni::STATUS_BAD_PARAMETER);
    EXPECT_EQ(apparatus_of(device), "pendulum length_m=1.5");
}

TEST_F(SimulatedRigDriver, BecomesAnotherApparatus) {
    openni::Device device;
    ASSERT_EQ(device.open("sim://laboratory?noise=none"), openni::STATUS_OK);
    EXPECT_EQ(apparatus_of(device), "pendulum");
    ASSERT_EQ(make(device, "collision mass_a_kg=0.5 offset_m=0.02"), openni::STATUS_OK);
    const RigState parked = state_of(device);
    EXPECT_EQ(parked.motion, Motion::at_rest);
    ASSERT_EQ(parked.body_count, 2);
    EXPECT_STREQ(parked.bodies[0].name, "ball_a");
    EXPECT_STREQ(parked.bodies[1].name, "ball_b");
    EXPECT_LT(parked.bodies[0].p_lab_m[0], -1.0);
    ASSERT_EQ(command(device, Action::displace), openni::STATUS_OK);
    ASSERT_TRUE(eventually([&] { return state_of(device).motion == Motion::held; }));
    EXPECT_NEAR(state_of(device).bodies[1].p_lab_m[1], 0.02, 1e-9);
    ASSERT_EQ(command(device, Action::release), openni::STATUS_OK);
    ASSERT_TRUE(eventually([&] { return state_of(device).bodies[1].v_lab_m_s[0] > 0.1; }));
    for (const char* wrong :
         {"colision",
          "collision mass=1",
          "collision mass_a_kg=1e9",
          "collision mass_a_kg",
          "",
          "incline friction=nan"})
        EXPECT_EQ(make(device, wrong), openni::STATUS_BAD_PARAMETER) << wrong;
    const std::string endless(kLongestApparatus + 1, ' ');
    EXPECT_EQ(make(device, "pendulum" + endless), openni::STATUS_BAD_PARAMETER);
}

TEST_F(SimulatedRigDriver, RefusesWhatItDoesNotUnderstand) {
    openni::Device device;
    EXPECT_NE(device.open("sim://"), openni::STATUS_OK);
    EXPECT_NE(device.open("sim://rig?colour=red"), openni::STATUS_OK);
    EXPECT_NE(device.open("sim://rig?noise=loud"), openni::STATUS_OK);
    ASSERT_EQ(device.open("sim://refuses"), openni::STATUS_OK);
    EXPECT_EQ(device.setProperty(kActuator, 1), openni::STATUS_BAD_PARAMETER);
    EXPECT_EQ(command(device, static_cast<Action>(9)), openni::STATUS_BAD_PARAMETER);
    EXPECT_EQ(command(device, Action::displace, 3.0), openni::STATUS_BAD_PARAMETER);
    EXPECT_EQ(device.setProperty(4711, 1), openni::STATUS_NOT_SUPPORTED);
    int number = 0;
    int size = sizeof(number);
    EXPECT_EQ(device.getProperty(kState, &number, &size), openni::STATUS_BAD_PARAMETER);
    EXPECT_EQ(
        device.setProperty(kFault, Fault{FaultKind::frozen, 0, -1.0}), openni::STATUS_BAD_PARAMETER
    );
}

TEST_F(SimulatedRigDriver, ShowsBlackAndIgnoresCommandsWhenToldTo) {
    openni::Device device;
    ASSERT_EQ(device.open("sim://faults"), openni::STATUS_OK);
    openni::VideoStream depth;
    ASSERT_EQ(depth.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
    ASSERT_EQ(depth.start(), openni::STATUS_OK);
    const auto centre = [&depth] {
        openni::VideoFrameRef frame;
        EXPECT_EQ(depth.readFrame(&frame), openni::STATUS_OK);
        return static_cast<const std::uint16_t*>(frame.getData())[100 * 640 + 320 + 40];
    };
    ASSERT_EQ(device.setProperty(kFault, Fault{FaultKind::black, 0, 600.0}), openni::STATUS_OK);
    EXPECT_TRUE(eventually([&] { return centre() == 0; }));
    ASSERT_EQ(device.setProperty(kFault, Fault{}), openni::STATUS_OK);
    EXPECT_TRUE(eventually([&] { return centre() != 0; }));

    ASSERT_EQ(
        device.setProperty(kFault, Fault{FaultKind::actuator_silent, 0, 600.0}), openni::STATUS_OK
    );
    EXPECT_EQ(command(device, Action::displace, 0.2), openni::STATUS_OK);
    for (int i = 0; i < 5; ++i)
        centre();
    EXPECT_EQ(state_of(device).motion, Motion::at_rest);
}

TEST_F(SimulatedRigDriver, VanishesWhenUnpluggedAndComesBack) {
    const std::string uri = "sim://loose";
    openni::Device device;
    ASSERT_EQ(device.open(uri.c_str()), openni::STATUS_OK);
    openni::VideoStream depth;
    ASSERT_EQ(depth.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
    ASSERT_EQ(depth.start(), openni::STATUS_OK);
    ASSERT_EQ(device.setProperty(kFault, Fault{FaultKind::unplugged, 0, 1.0}), openni::STATUS_OK);
    EXPECT_TRUE(eventually([&] { return !listed(uri); }));
    EXPECT_EQ(command(device, Action::stop), openni::STATUS_NO_DEVICE);
    depth.destroy();
    device.close();
    EXPECT_TRUE(eventually([&] { return listed(uri); }));
    ASSERT_EQ(device.open(uri.c_str()), openni::STATUS_OK);
    ASSERT_EQ(depth.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
    ASSERT_EQ(depth.start(), openni::STATUS_OK);
    openni::VideoFrameRef frame;
    EXPECT_EQ(depth.readFrame(&frame), openni::STATUS_OK);
}

TEST_F(SimulatedRigDriver, OpensAndClosesWhileRunning) {
    for (int i = 0; i < 4; ++i) {
        openni::Device first;
        openni::Device second;
        ASSERT_EQ(first.open("sim://one?noise=khoshelham"), openni::STATUS_OK);
        ASSERT_EQ(second.open("sim://two?noise=none"), openni::STATUS_OK);
        openni::VideoStream depth;
        openni::VideoStream other;
        ASSERT_EQ(depth.create(first, openni::SENSOR_DEPTH), openni::STATUS_OK);
        ASSERT_EQ(other.create(second, openni::SENSOR_DEPTH), openni::STATUS_OK);
        ASSERT_EQ(depth.start(), openni::STATUS_OK);
        ASSERT_EQ(other.start(), openni::STATUS_OK);
        openni::VideoFrameRef frame;
        EXPECT_EQ(depth.readFrame(&frame), openni::STATUS_OK);
        EXPECT_EQ(other.readFrame(&frame), openni::STATUS_OK);
        if (i % 2 == 0) depth.stop();
        frame.release();
        depth.destroy();
        other.destroy();
    }
}

}  // namespace
}  // namespace kinectlab::simulated_rig
