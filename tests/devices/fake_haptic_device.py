"""A haptic device for Trocar's seam in fifty lines: a point of 0.2 kg in a soft hand. docs/guides/haptics.md has the format.

    fake_haptic_device.py PORT [SECONDS]      then: trocar train EXERCISE --haptics seam:PORT

A device of one's own puts its position where `x` is, and gives `force` to its motors.
"""
import math
import socket
import struct
import sys
import time

PORT, SECONDS = int(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 1e9
PERIOD, MASS, STIFFNESS, DAMPING = 0.001, 0.2, 400.0, 8.0


def abilities():
    """What it can do: N, N/m, N s/m, own N s/m, own N, m, and three half sides in m."""
    return struct.pack("<4sI9d", b"TRA1", 0, 5, 1000, 2, 4, 0, 1e-5, 0.1, 0.1, 0.1)


def sample(number, x):
    """Number, position in m, turn w x y z, grip 0..1, switches, nothing."""
    return struct.pack("<4sI8dII", b"TRS1", number, *x, 1, 0, 0, 0, 0, 0, 0)


def forces(link, last):
    """The newest force, or the last one where none has come."""
    while True:
        try:
            datagram = link.recv(256)
        except (BlockingIOError, ConnectionRefusedError):
            return last
        if len(datagram) == 64 and datagram[:4] == b"TRF1":
            last = struct.unpack("<4sI7d", datagram)[2:5]


link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
link.connect(("127.0.0.1", PORT))
link.setblocking(False)
x, v, force, most, start, number = [0.0] * 3, [0.0] * 3, (0.0,) * 3, 0.0, time.monotonic(), 0
while number * PERIOD < SECONDS:
    hand = (0.01 * math.sin(number * PERIOD), 0.0, -0.01)
    for i in range(3):
        pull = force[i] + STIFFNESS * (hand[i] - x[i]) - DAMPING * v[i]
        v[i] += PERIOD * pull / MASS
        x[i] += PERIOD * v[i]
    for datagram in ([abilities()] if number % 100 == 0 else []) + [sample(number, x)]:
        try:
            link.send(datagram)
        except ConnectionRefusedError:
            pass  # nobody listens yet
    force = forces(link, force)
    most = max(most, math.hypot(*force))
    number += 1
    time.sleep(max(0.0, start + number * PERIOD - time.monotonic()))
print(f"{number} samples, most force {most:.3f} N, ended at {x[2]:.5f} m")
