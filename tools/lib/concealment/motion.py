"""Motions of a vehicle in the tangent plane of its origin: north, east, down; smooth sums of steps, with exact derivatives."""

import math


class Steps:
    """A value that changes by smooth steps: quintic, so that rate and acceleration of the value are continuous."""

    def __init__(self, value):
        self.first = value
        self.steps = []  # begin, duration, change, in order and apart

    def change(self, begin, duration, by):
        self.steps.append((begin, duration, by))

    def table(self, times):
        """(value, rate) at ascending times."""
        result = []
        done, k = self.first, 0
        for t in times:
            while k < len(self.steps) and t >= self.steps[k][0] + self.steps[k][1]:
                done += self.steps[k][2]
                k += 1
            value, rate = done, 0.0
            if k < len(self.steps) and t > self.steps[k][0]:
                begin, duration, by = self.steps[k]
                s = (t - begin) / duration
                value += by * s * s * s * (10.0 + s * (-15.0 + 6.0 * s))
                rate = by * 30.0 * s * s * (1.0 - s) * (1.0 - s) / duration
            result.append((value, rate))
        return result


class Vehicle:
    """What a kind of vehicle does: speeds, how long and how far it turns, how it leans."""

    def __init__(self, speeds, stops, turns, turn_s, lean, slopes):
        self.speeds, self.stops, self.turns, self.turn_s, self.lean, self.slopes = speeds, stops, turns, turn_s, lean, slopes


VEHICLES = {
    "car": Vehicle((4.0, 18.0), 0.25, (20.0, 90.0), (4.0, 8.0), 2.0, 4.0),
    "drone": Vehicle((2.0, 10.0), 0.2, (30.0, 180.0), (4.0, 8.0), 15.0, 12.0),
    "aircraft": Vehicle((45.0, 65.0), 0.0, (30.0, 180.0), (12.0, 30.0), 28.0, 6.0),
}


class Roughness:
    """Stretches of rough ground, between 0 and 1 over time: there the body nods and rolls, a quarter of a period apart, or shakes."""

    def __init__(self, kinds, duration, draw):
        self.nods = math.radians(0.4) if "nodding" in kinds else 0.0  # both ways
        self.shakes = 1.5 if "shaking" in kinds else 0.0  # m/s^2, root mean square along every axis
        self.share = Steps(0.0)
        self.rate = 2.0 * math.pi * draw.uniform(6.0, 9.0)
        # 15 to 45 Hz: what a second shows of it does not depend on where it begins.
        self.waves = [[(2.0 * math.pi * draw.uniform(15.0, 45.0), draw.uniform(0.0, 6.3)) for _ in range(6)] for _ in range(3)]
        t = draw.uniform(40.0, 60.0)
        while t < duration - 60.0:
            lasts = draw.uniform(20.0, 60.0)
            self.share.change(t, 1.0, 1.0)
            self.share.change(t + lasts, 1.0, -1.0)
            t += lasts + draw.uniform(20.0, 60.0)

    def nodding(self, times):
        """((pitch, its rate), (roll, its rate)) at ascending times."""
        for t, (share, change) in zip(times, self.share.table(times)):
            s, c = math.sin(self.rate * t), math.cos(self.rate * t)
            yield tuple((self.nods * share * a, self.nods * (change * a + share * self.rate * b)) for a, b in ((s, c), (c, -s)))

    def shaking(self, t, share):
        """What a sample has of it, by axis."""
        size = self.shakes * share * math.sqrt(2.0 / 6.0)
        return [size * sum(math.sin(w * t + p) for w, p in waves) for waves in self.waves]


class Motion:
    """Speed along the body's x axis, heading, pitch and roll over time."""

    def __init__(self, kind, duration, static, draw):
        self.roughness = None
        v = VEHICLES[kind]
        self.speed, self.yaw = Steps(0.0), Steps(draw.uniform(-math.pi, math.pi))
        self.pitch, self.roll = Steps(0.0), Steps(0.0)
        t, speed, pitch = static, 0.0, 0.0
        while t < duration - 30.0:
            stops = draw.random() < v.stops and speed > 0.0
            wanted = 0.0 if stops else draw.uniform(*v.speeds)
            takes = max(3.0, abs(wanted - speed) / draw.uniform(1.0, 2.5))
            self.speed.change(t, takes, wanted - speed)
            speed = wanted
            slope = math.radians(draw.uniform(-v.slopes, v.slopes)) - pitch
            self.pitch.change(t + 0.3, takes, slope)
            pitch += slope
            t += takes + 0.5
            if stops:
                t += draw.uniform(4.0, 10.0)
                continue
            turn_s = draw.uniform(*v.turn_s)
            angle = math.radians(draw.uniform(*v.turns)) * draw.choice((-1.0, 1.0))
            lean = math.copysign(math.radians(draw.uniform(0.5, 1.0) * v.lean), angle)
            self.yaw.change(t + 1.0, turn_s, angle)
            self.roll.change(t, 2.0, lean)
            self.roll.change(t + turn_s, 2.0, -lean)
            t += turn_s + 2.5 + draw.uniform(0.0, 6.0)

    def table(self, times):
        pitch, roll = self.pitch.table(times), self.roll.table(times)
        if self.roughness:
            nodding = list(self.roughness.nodding(times))
            pitch = [(a + n[0][0], b + n[0][1]) for (a, b), n in zip(pitch, nodding)]
            roll = [(a + n[1][0], b + n[1][1]) for (a, b), n in zip(roll, nodding)]
        return zip(self.speed.table(times), self.yaw.table(times), pitch, roll)
