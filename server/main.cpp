#include "server/commands/commands.hpp"

int main(int argc, char** argv) {
    return kinectlab::commands::run(argc, argv);
}
