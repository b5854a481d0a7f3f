// What must bear any bytes at all: each function returns, or ends the program when a demand is not met.
//
// The fuzzers call them with what they think of (`make fuzz`), the ordinary tests with the inputs in corpus/.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace rayshade {

// A scene: it is read or refused, and what is read keeps the order that SceneSink promises.
void takeAnyScene(std::span<const std::byte> input);

// A picture: it is read as a whole or refused with a message.
void takeAnyPicture(std::span<const std::byte> input);

// Packets into the tasks, each with its size (16 bits, little-endian) in front: no crash, no hang, no more memory than
// the bytes justify.
void takeAnyPackets(std::span<const std::byte> input);

}  // namespace rayshade
