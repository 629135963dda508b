"""Random scene maker: a scene for a seed, with what is known of it for whoever judges its run.

The same seed and number of bodies make the same scene on every machine. A scene is drawn as a user
might put one together: a size, a floor, a few shapes, a way to lay them out, now and then an effect
or a dial that is not the default. Nothing overlaps as it begins.
"""
import dataclasses
import math
import random

LEAST_SIZE, GREATEST_SIZE = 0.005, 50.0  # m, half extents
GREATEST_ASPECT = 100.0
GREATEST_SPEED = 100.0                   # m/s
SLOW_BODIES = 8                          # at most, of scenes in a mode that takes its time
SLOW_SHARE = 0.1
GRAVITY = 9.81
GAP = 1.02                               # from body to body, of their sizes


@dataclasses.dataclass
class Piece:
    """A shape, and what a layout has to know of it: half extents and greatest radius, in m."""
    kind: str
    scene: dict
    half: tuple
    radius: float
    inner: float      # m, the smallest half extent
    volume: float     # m3, about
    rolls: bool = False
    files: dict = dataclasses.field(default_factory=dict)


@dataclasses.dataclass
class Made:
    """A scene, with what is known of it.

    floor       height of the floor at a place, in m, or None where there is none
    has_rim     the floor ends where bodies may get to
    driven      something puts energy in that no potential tells of
    kept        nothing may take energy out either
    rests_by    s, when all of it lies still; infinity where it need not
    slow        in a mode that takes its time
    """
    scene: dict
    files: dict
    classes: set
    pieces: list      # [bodies], None for what is no dynamic body
    mass_of: list = dataclasses.field(default_factory=list)  # kg, of the dynamic ones, about
    floor: object = None
    has_rim: bool = False
    driven: bool = False
    kept: bool = False
    rests_by: float = math.inf
    slow: bool = False

    @property
    def mass(self):
        return sum(self.mass_of)


def log_uniform(dice, least, most):
    return math.exp(dice.uniform(math.log(least), math.log(most)))


def unit_vector(dice):
    while True:
        v = [dice.uniform(-1, 1) for _ in range(3)]
        length = math.hypot(*v)
        if 0.1 < length <= 1:
            return [x / length for x in v]


def quaternion(axis, angle):
    q = [math.cos(angle / 2), *(x * math.sin(angle / 2) for x in axis)]
    length = math.hypot(*q)
    return [x / length for x in q]


def any_turn(dice):
    return quaternion(unit_vector(dice), dice.uniform(0, math.pi))


# Shapes. Each is drawn about its origin, from its smallest half extent and its aspect.

def sphere(dice, size, aspect):
    return Piece("sphere", {"sphere": {"radius": size}}, (size,) * 3, size, size,
                 4.19 * size ** 3, True)


def box_of(half):
    return Piece("box", {"box": {"half_extents": list(half)}}, tuple(half), math.hypot(*half),
                 min(half), 8 * half[0] * half[1] * half[2])


def box(dice, size, aspect):
    middle = size * aspect ** dice.choice([0, dice.random(), 1])
    half = [size, middle, size * aspect]
    dice.shuffle(half)
    return box_of(half)


def capsule(dice, size, aspect):
    reach = size * aspect
    half_length = max(reach - size, 0.1 * size)
    return Piece("capsule", {"capsule": {"radius": size, "half_length": half_length}},
                 (size, size, size + half_length), size + half_length, size,
                 3.14 * size ** 2 * (2 * half_length + 1.33 * size), True)


def cylinder(dice, size, aspect):
    flat = dice.random() < 0.4
    radius, half_length = (size * aspect, size) if flat else (size, size * aspect)
    return Piece("cylinder", {"cylinder": {"radius": radius, "half_length": half_length}},
                 (radius, radius, half_length), math.hypot(radius, half_length), size,
                 6.28 * radius ** 2 * half_length, True)


def hull(dice, size, aspect):
    stretch = [size, size * aspect ** dice.random(), size * aspect]
    count = dice.choice([6, 8, 12, 20, 40])
    # One in every octant first, so that the middle is well inside.
    signs = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    points = [[s * dice.uniform(0.5, 1) * r for s, r in zip(sign, stretch)] for sign in signs]
    points += [[x * r for x, r in zip(unit_vector(dice), stretch)] for _ in range(count - 6)]
    radius = max(math.hypot(*p) for p in points)
    half = tuple(max(abs(p[axis]) for p in points) for axis in range(3))
    return Piece("hull", {"hull": {"points": points}}, half, radius, size / 2,
                 4 * stretch[0] * stretch[1] * stretch[2], count > 12)


def compound(dice, size, aspect):
    """A bar with a head at its end, or a cross: the parts are shapes of their own."""
    long = size * max(aspect, 2)
    bar, head = box_of([long, size, size]), box_of([size, size * 2.5, size])
    at = dice.choice([0.0, long])
    half = (max(long, at + size), 2.5 * size, size)
    return Piece("compound", {"compound": [{"shape": bar.scene}, {"shape": head.scene,
                                                                  "position": [at, 0, 0]}]},
                 half, math.hypot(*half), size, bar.volume + head.volume)


def prism(outline, half_height):
    """Vertices and triangles of a closed prism over an outline that all is seen in from [0, 0]."""
    n = len(outline)
    vertices = [[0, 0, -half_height], [0, 0, half_height]]
    vertices += [[x, y, z] for z in (-half_height, half_height) for x, y in outline]
    triangles = []
    for i in range(n):
        a, b = 2 + i, 2 + (i + 1) % n
        triangles += [[0, b, a], [1, a + n, b + n], [a, b, b + n], [a, b + n, a + n]]
    return vertices, triangles


def star(dice, size, aspect):
    points = dice.choice([3, 4, 5])
    inner, outer = size, 3 * size
    turn = math.pi / points
    outline = [((outer, inner)[i % 2] * math.cos(i * turn), (outer, inner)[i % 2] * math.sin(i * turn))
               for i in range(2 * points)]
    height = size * min(aspect, 20)
    return prism(outline, height), (outer, outer, height)


def torus(dice, size, aspect):
    ring, around, across = size * (1.5 + min(aspect, 20)), 16, 8
    vertices, triangles = [], []
    for i in range(around):
        for k in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * k / across
            r = ring + size * math.cos(b)
            vertices.append([r * math.cos(a), r * math.sin(a), size * math.sin(b)])
            u, v = i * across, (i + 1) % around * across
            w = (k + 1) % across
            triangles += [[u + k, v + k, v + w], [u + k, v + w, u + w]]
    return (vertices, triangles), (ring + size, ring + size, size)


def obj_text(vertices, triangles):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices]
    return "\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]) + "\n"


def mesh(dice, size, aspect):
    kind = dice.choice([star, torus])
    (vertices, triangles), half = kind(dice, size, aspect)
    name = f"{kind.__name__}_{dice.randrange(10 ** 9)}.obj"
    return Piece("mesh", {"mesh": {"file": name}}, half, math.hypot(*half), size,
                 2 * half[0] * half[1] * half[2], kind is torus,
                 {name: obj_text(vertices, triangles)})


SHAPES = {"sphere": sphere, "box": box, "capsule": capsule, "cylinder": cylinder, "hull": hull,
          "compound": compound, "mesh": mesh}


class Maker:
    """Draws one scene; made() is the answer."""

    def __init__(self, seed, most_bodies):
        self.dice = random.Random(f"random scene {seed}")
        self.slow = self.dice.random() < SLOW_SHARE
        self.most_bodies = min(most_bodies, SLOW_BODIES) if self.slow else most_bodies
        self.scene = {"throng": 1, "settings": {}, "materials": {}, "shapes": {}, "bodies": []}
        self.made = Made(self.scene, {}, set(), [], slow=self.slow)
        self.speed = self.spin = 0.0
        self.top = 0.0

    def some(self, share):
        return self.dice.random() < share

    def mark(self, name):
        self.made.classes.add(name)

    def draw(self):
        self.draw_material()
        self.draw_pieces()
        self.draw_room()
        self.lay_out()
        self.draw_speeds()
        self.draw_masses()
        self.draw_effects()
        self.draw_dials()
        self.draw_rest()
        return self.made

    # What bodies are made of.

    def draw_material(self):
        dice = self.dice
        restitution = 0.0
        if self.some(0.4):
            restitution = dice.choice([dice.uniform(0, 0.4), dice.uniform(0.4, 0.95), 1.0])
        self.friction = 0.0 if self.some(0.1) else dice.uniform(0.1, 1.2)
        self.restitution = restitution
        material = {"density": log_uniform(dice, 100, 10000), "friction": self.friction,
                    "restitution": restitution}
        self.density = material["density"]
        self.rolling = 0.0
        self.scene["materials"]["stuff"] = material
        self.mark("friction " + ("0" if self.friction == 0 else "above 0"))
        self.mark("restitution " + ("1" if restitution == 1 else "above 0.5" if restitution > 0.5
                                    else "up to 0.5"))

    # Sizes are of smallest half extents, so aspects are kept below what the greatest size allows.
    def draw_pieces(self):
        dice = self.dice
        self.size = log_uniform(dice, LEAST_SIZE, 0.5 * GREATEST_SIZE)
        mixed = self.some(0.2)
        aspect = log_uniform(dice, 3, GREATEST_ASPECT) if self.some(0.35) else dice.uniform(1, 3)
        kinds = dice.sample(list(SHAPES), dice.choice([1, 1, 1, 2, 3]))
        spread = 8 if mixed else 1.6
        self.pieces = []
        for kind in kinds:
            for _ in range(dice.choice([1, 2, 3])):
                size = self.size * log_uniform(dice, 1 / spread, spread)
                size = min(max(size, LEAST_SIZE), GREATEST_SIZE)
                own = aspect * dice.uniform(0.8, 1)
                own = max(1.0, min(own, GREATEST_SIZE / size))
                self.add_shape(SHAPES[kind](dice, size, own))
            self.mark(f"shape {kind}")
        if self.some(0.15):
            self.rolling = 0.02 * min(p.inner for p in self.pieces)
            self.scene["materials"]["stuff"]["rolling_friction"] = self.rolling
            self.mark("rolling friction")
        widest = max(max(p.half) / min(p.half) for p in self.pieces)
        self.mark("aspect " + ("to 1:3" if widest <= 3.5 else "to 1:10" if widest <= 10
                               else "to 1:30" if widest <= 30 else "to 1:100"))
        self.mark("size " + ("below 2 cm" if self.size < 0.02 else "to 20 cm" if self.size < 0.2
                             else "to 2 m" if self.size < 2 else "above 2 m"))
        if mixed:
            self.mark("mixed sizes")

    def add_shape(self, piece):
        name = f"{piece.kind}{len(self.pieces)}"
        shapes = self.scene["shapes"]
        if piece.kind == "compound":
            for i, part in enumerate(piece.scene["compound"]):
                shapes[f"{name}_{i}"] = part["shape"]
                part["shape"] = f"{name}_{i}"
        shapes[name] = piece.scene
        piece.name = name
        self.pieces.append(piece)
        self.made.files.update(piece.files)

    # What bodies fall on.

    def draw_room(self):
        dice = self.dice
        reach = max(p.radius for p in self.pieces)
        self.width = 60 * reach + 2 * GREATEST_SPEED
        kind = dice.choices(["plane", "box", "tiles", "mesh", "walls", "none"],
                            [40, 20, 13, 13, 9, 5])[0]
        self.room = kind
        self.weightless = kind == "none" or (kind == "walls" and self.some(0.6))
        if self.weightless:
            self.scene["gravity"] = [0, 0, 0]
        else:
            self.scene["gravity"] = [0, 0, -GRAVITY]
        self.mark(f"floor {kind}")
        if kind != "none":
            getattr(self, f"add_{kind}")(reach)

    def add_fixed(self, name, shape, position=(0, 0, 0)):
        self.scene["shapes"].setdefault(name, shape)
        self.scene["bodies"].append({"shape": name, "material": "stuff", "motion": "static",
                                     "position": list(position)})
        self.made.pieces.append(None)

    def add_plane(self, reach):
        self.add_fixed("floor", {"plane": {"normal": [0, 0, 1]}})
        self.made.floor = lambda x, y: 0.0

    def add_box(self, reach):
        depth = self.dice.choice([0.2, 1, 10]) * reach
        self.add_fixed("floor", {"box": {"half_extents": [self.width, self.width, depth]}},
                       [0, 0, -depth])
        self.made.floor = lambda x, y: 0.0 if max(abs(x), abs(y)) < self.width else -math.inf

    def add_tiles(self, reach):
        count, half = 5, 8 * reach
        for i in range(count):
            for k in range(count):
                at = [(2 * i - count + 1) * half, (2 * k - count + 1) * half, -reach]
                self.add_fixed("floor", {"box": {"half_extents": [half, half, reach]}}, at)
        edge = count * half
        self.made.has_rim = True
        self.made.floor = lambda x, y: 0.0 if max(abs(x), abs(y)) < edge else -math.inf

    def add_mesh(self, reach):
        """Flat, or hills that are much wider than the bodies."""
        cells, side = 12, 8 * reach
        height = self.dice.choice([0.0, 0.5]) * reach
        heights = [[self.dice.uniform(0, height) for _ in range(cells + 1)] for _ in range(cells + 1)]
        vertices = [[(i - cells / 2) * side, (k - cells / 2) * side, heights[i][k]]
                    for i in range(cells + 1) for k in range(cells + 1)]
        triangles = []
        for i in range(cells):
            for k in range(cells):
                a = i * (cells + 1) + k
                b = a + cells + 1
                triangles += [[a, b, b + 1], [a, b + 1, a + 1]]
        self.made.files["ground.obj"] = obj_text(vertices, triangles)
        self.add_fixed("floor", {"mesh": {"file": "ground.obj"}})
        edge = cells / 2 * side
        # Nothing is below the lowest place of the cell that it is over.
        def floor(x, y):
            if max(abs(x), abs(y)) >= edge:
                return -math.inf
            i, k = int(x / side + cells / 2), int(y / side + cells / 2)
            return min(heights[i][k], heights[i + 1][k], heights[i][k + 1], heights[i + 1][k + 1])
        self.made.floor = floor
        self.made.has_rim = True
        self.top = height
        self.hilly = height > 0

    def add_walls(self, reach):
        """A closed room of planes about the bodies, which lay_out() gives its size."""
        self.made.floor = lambda x, y: 0.0

    def close_walls(self, low, high):
        for axis in range(3):
            for side, edge in ((1, low[axis]), (-1, high[axis])):
                normal = [0, 0, 0]
                normal[axis] = side
                offset = side * edge if axis < 2 else side * (0.0 if side > 0 else edge)
                self.add_fixed(f"wall{axis}{side}", {"plane": {"normal": normal, "offset": offset}})

    # Where bodies are.

    def lay_out(self):
        dice = self.dice
        count = max(1, round(log_uniform(dice, 1, self.most_bodies)))
        chosen = [dice.choice(self.pieces) for _ in range(count)]
        square = all(p.kind in ("box", "cylinder") for p in chosen)
        way = "stack" if square and not self.weightless and self.some(0.3) else \
            dice.choice(["drop", "drop", "bundle"])
        self.mark(f"layout {way}")
        self.lift = self.top + self.size * dice.choice([0.01, 0.5, 3])
        self.first = len(self.scene["bodies"])
        {"stack": self.stack, "drop": self.drop, "bundle": self.bundle}[way](chosen)
        self.way = way
        if self.room == "walls":
            bodies = self.scene["bodies"][self.first:]
            reach = max(p.radius for p in chosen)
            self.close_walls(
                [min(b["position"][i] for b in bodies) - 1.5 * reach for i in range(3)],
                [max(b["position"][i] for b in bodies) + 1.5 * reach for i in range(3)])

    def place(self, piece, position, orientation):
        self.scene["bodies"].append({"name": f"b{len(self.scene['bodies'])}", "shape": piece.name,
                                     "material": "stuff", "position": position,
                                     "orientation": orientation})
        self.made.pieces.append(piece)

    def grid(self, chosen, half, turn):
        """Rows on rows: cells of these half extents, as many along x and y as makes sense."""
        across = max(1, round(len(chosen) ** self.dice.choice([0, 1 / 3, 1 / 2])))
        for i, piece in enumerate(chosen):
            cell = [i % across, i // across % across, i // across ** 2]
            shift = [across - 1, across - 1, 0]
            position = [(2 * c - s) * GAP * h for c, s, h in zip(cell, shift, half)]
            position[2] += self.lift + half[2]
            self.place(piece, position, turn())

    def drop(self, chosen):
        reach = max(p.radius for p in chosen)
        self.grid(chosen, [reach] * 3, lambda: any_turn(self.dice))

    def bundle(self, chosen):
        """All the same way round, but for a little: slender ones lie closely."""
        most = max(max(p.half) / min(p.half) for p in chosen)
        angle = 0.02 / most
        half = [max(p.half[i] for p in chosen) + 0.02 * min(p.inner for p in chosen)
                for i in range(3)]
        self.grid(chosen, half, lambda: quaternion(unit_vector(self.dice),
                                                   self.dice.uniform(0, angle)))

    def stack(self, chosen):
        """One on another, the widest lowest or not, with their flat sides down."""
        if self.some(0.6):
            chosen.sort(key=lambda p: -p.half[0] * p.half[1])
        towers = self.dice.choice([1, 2])
        reach = max(p.radius for p in chosen)
        heights = [self.top] * towers
        for i, piece in enumerate(chosen):
            tower = i % towers
            at = [2.5 * reach * tower, 0.0, heights[tower] + piece.half[2]]
            heights[tower] += 2 * piece.half[2]
            self.place(piece, at, [1, 0, 0, 0])

    # What bodies do at first.

    def moving(self):
        return self.scene["bodies"][self.first:self.first + sum(
            p is not None for p in self.made.pieces)]

    def draw_speeds(self):
        dice = self.dice
        if self.way == "stack" or self.some(0.45) and not self.weightless:
            return
        typical = math.sqrt(GRAVITY * self.size)
        self.speed = log_uniform(dice, 5, GREATEST_SPEED) if self.some(0.3) else \
            dice.uniform(0.1, 3) * typical
        self.spin = dice.choice([0.0, 0.3, 1.0]) * min(self.speed / self.size, 50)
        self.mark("speed " + ("above 30 m/s" if self.speed > 30 else "to 30 m/s" if self.speed > 5
                              else "to 5 m/s"))
        fast = self.speed > 5 and self.some(0.3)
        for body in self.moving():
            body["velocity"] = [self.speed * dice.uniform(0.2, 1) * x for x in unit_vector(dice)]
            if self.spin > 0:
                body["angular_velocity"] = [self.spin * dice.random() * x
                                            for x in unit_vector(dice)]
            if fast:
                body["fast"] = True

    def draw_masses(self):
        dice = self.dice
        self.masses = self.made.mass_of
        self.masses += [self.density * p.volume for p in self.made.pieces if p is not None]
        if not self.some(0.2):
            return
        most = log_uniform(dice, 10, 1000)
        middle = sum(self.masses) / len(self.masses)
        for i, body in enumerate(self.moving()):
            body["mass"] = self.masses[i] = middle * log_uniform(dice, most ** -0.5, most ** 0.5)
        self.mark("mass ratio " + ("to 1:100" if most <= 100 else "to 1:1000"))

    # What else acts on them.

    def draw_effects(self):
        chances = [(0.10, self.add_springs), (0.06, self.add_pivots), (0.05, self.add_locks),
                   (0.05, self.add_drive), (0.07, self.add_kinematic), (0.08, self.add_drag),
                   (0.04, self.add_attractor), (0.04, self.add_force)]
        self.plain = True
        for share, add in chances:
            if self.some(share):
                self.plain = False
                self.mark(add.__name__.removeprefix("add_"))
                add()

    def add_springs(self):
        dice, bodies = self.dice, self.moving()
        springs = []
        damping = dice.choice([0, 0.05, 1])
        for i, body in enumerate(bodies):
            if not self.some(0.5):
                continue
            other = bodies[i - 1] if i > 0 and self.some(0.7) else None
            mass = min(self.masses[i], self.masses[i - 1] if other else self.masses[i])
            rate = 2 * math.pi * log_uniform(dice, 0.3, 20)
            at = other["position"] if other else [body["position"][0], body["position"][1],
                                                  body["position"][2] + 10 * self.size]
            length = math.dist(at, body["position"])
            springs.append({"a": body["name"], "b": other["name"] if other else None,
                            "at_b": [0, 0, 0] if other else at,
                            "stiffness": mass * rate ** 2, "damping": 2 * mass * rate * damping,
                            "length": length * dice.uniform(0.8, 1.1)})
        self.scene["springs"] = springs

    def add_pivots(self):
        for body, piece in zip(self.moving(), filter(None, self.made.pieces)):
            if self.some(0.3):
                body["pivot"] = [0, 0, self.dice.choice([-1, 1]) * piece.half[2]]
                body.pop("velocity", None)

    def add_locks(self):
        lock = self.dice.choice(["lock_rotation", "lock_position"])
        self.mark(lock)
        for body in self.moving():
            if self.some(0.4) and "pivot" not in body:
                body[lock] = True
                body.pop("velocity" if lock == "lock_position" else "angular_velocity", None)

    def add_drive(self):
        self.made.driven = True
        for body in self.moving():
            if self.some(0.3) and not body.keys() & {"pivot", "lock_position"}:
                body["drive_velocity"] = [self.dice.choice([None, self.dice.uniform(-2, 2)])
                                          for _ in range(2)] + [None]

    def add_kinematic(self):
        """A paddle that turns, or slides, above the floor: it presses nothing into it."""
        self.made.driven = True
        reach = max(p.radius for p in self.pieces)
        self.scene["shapes"]["paddle"] = {"box": {"half_extents": [2 * reach, self.size, self.size]}}
        edge = max(abs(b["position"][0]) for b in self.moving()) + 3.5 * reach
        paddle = {"shape": "paddle", "material": "stuff", "motion": "kinematic",
                  "position": [edge, 0, self.top + 3 * self.size]}
        if self.some(0.5):
            paddle["angular_velocity"] = [0, 0, self.dice.uniform(-3, 3)]
        else:
            paddle["velocity"] = [-self.dice.uniform(0.1, 2) * math.sqrt(GRAVITY * self.size), 0, 0]
        self.scene["bodies"].append(paddle)
        self.made.pieces.append(None)

    def add_drag(self):
        dice = self.dice
        if self.some(0.4):
            self.scene["wind"] = [dice.uniform(-10, 10) for _ in range(3)]
            self.made.driven = True
            self.mark("wind")
        rate = 1 / log_uniform(dice, 0.02, 30)
        for i, body in enumerate(self.moving()):
            mass, reach = self.masses[i], max(p.radius for p in self.pieces)
            body["drag"] = {"linear": mass * rate, "angular": 0.1 * mass * reach ** 2 * rate}

    def add_attractor(self):
        dice, reach = self.dice, max(p.radius for p in self.pieces)
        away = [30 * reach * x for x in unit_vector(dice)]
        away[2] = abs(away[2]) + 10 * reach
        pull = dice.uniform(-3, 3)  # m/s2 in the middle of the bodies
        self.scene["attractors"] = [{"position": away,
                                     "strength": pull * sum(x * x for x in away)}]
        self.made.driven = True

    def add_force(self):
        self.made.driven = True
        for i, body in enumerate(self.moving()):
            if self.some(0.3):
                weight = self.masses[i] * GRAVITY
                body["force"] = [weight * self.dice.uniform(-0.3, 0.3) for _ in range(3)]
                if "lock_rotation" not in body:
                    body["torque"] = [0.1 * weight * self.size * self.dice.uniform(-1, 1)
                                      for _ in range(3)]

    # Dials: most scenes are run by default.

    def draw_dials(self):
        dice, settings = self.dice, self.scene["settings"]
        if self.slow:
            settings.update(dice.choice([{"overlap": "back_up"}, {"overlap": "subdivide"},
                                         {"solver": "direct"}]))
        elif self.some(0.25):
            settings.update(dice.choice([
                {"solver": "pgs"}, {"response": "penalty"}, {"response": "kinematic"},
                {"precision": "double"}, {"friction_at": "points"}, {"friction_cone": "pyramid"},
                {"sleep": "off"},
                {"integrator": dice.choice(["midpoint", "splitting", "rk4"])},
                {"rotation": dice.choice(["rotation_vector", "matrix"])},
                {"narrowphase": dice.choice(["gjk", "sat", "chung_wang", "clip_volume",
                                             "containment"])},
                {"method_start": dice.choice(["cold", "plain"])},
                {"bounds_filter": dice.choice(["sphere", "k_dop:14", "k_dop:26"])},
                {"broadphase": dice.choice(["embree", "grid", "sweep", "all_pairs"])},
                {"toi_method": dice.choice(["bisection", "conservative"])},
                {"contact_rate": dice.choice([0.1, 0.5, "fixed:30"])}]))
        if self.some(0.15):
            settings["dt"] = dice.choice(["1/30", "1/120", "1/240"])
        if self.some(0.15):
            settings["substeps"] = dice.choice([1, 2, 8, 16])
        if any(p.kind == "mesh" for p in self.pieces) and self.some(0.6):
            settings["nonconvex"] = dice.choice(["voxels", "parts", "spheres", "depth_image", "hull"])
        if self.slow and self.some(0.2):
            settings["impact_law"] = "simultaneous"
        for name, value in settings.items():
            self.mark(f"{name} {value}")
        if not settings:
            self.mark("default dials")

    # What is to be expected of the end.

    def draw_rest(self):
        gone = self.made
        lossless = self.restitution == 1 and self.friction == 0
        gone.kept = lossless and self.plain and self.room == "walls" and self.speed > 0
        angular = not any(p.rolls for p in self.pieces) and self.friction >= 0.2
        hilly = getattr(self, "hilly", False)
        if not (angular and self.plain) or self.weightless or hilly or self.restitution >= 0.5 \
                or self.room in ("none", "tiles"):
            return
        height = max(b["position"][2] for b in self.moving())
        reach = max(p.radius for p in self.pieces)
        fall = math.sqrt(2 * height / GRAVITY) + 2 * self.speed / GRAVITY
        gone.rests_by = 1 + 4 * fall + 20 * math.sqrt(reach / GRAVITY) \
            + 2 * self.speed / (self.friction * GRAVITY)


def make(seed, most_bodies):
    return Maker(seed, most_bodies).draw()
