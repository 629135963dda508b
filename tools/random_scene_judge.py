"""Random scene judge: what a run of a random scene promises, and which of it was not kept.

Every bound follows from the scene: a share of its greatest motion, of its smallest thickness, of
what one step of falling gives. None is a scene's own.
"""
import csv
import json
import math

# Of the greatest kinetic energy: what may be made over a run without a word, as `throng run` has it.
ENERGY_SHARE = 0.01
# Of the energy of who neither rubs nor gives way: what a run may lose or gain.
KEPT_SHARE = 0.02
# m/s, by all of a scene together: bodies that lie still may tremble slower than this.
REST_SPEED = 0.02
# Of the smallest thickness in a scene: how deep any two may be in one another once all is at rest.
OVERLAP_SHARE = 0.05
# ms: steps that take longer have lost their way, on any machine however busy: the hundredth longest,
# and any of them. Modes that take their time have ten times as much.
STEP_MS, ANY_STEP_MS, SLOW_TIMES = 50, 1000, 10

# Ways to step that give energy or lose it by what they are; the rest is judged all the same.
TEXTBOOK = {"response": {"kinematic"}, "integrator": {"euler"}, "gyroscopic": {"explicit", "off"},
            "rotation": {"quaternion_euler", "matrix_euler", "matrix_euler_repaired"}}


class Run:
    """What a run left behind: exit code, last words, stats and final states.

    stretch: time by the clock over time of the processor, which others may use as well
    first: stats after one step, of what has stand-ins for its shapes
    held: stats of when energy began to be gained, of what gained any
    """

    def __init__(self, code, words, stats=None, before=None, bodies=(), timed_out=False, stretch=1,
                 first=None, held=None):
        self.code, self.words, self.timed_out = code, words, timed_out
        self.stretch = max(stretch, 1)
        self.stats, self.before, self.bodies = stats or {}, before or {}, bodies
        self.first, self.held = first or {}, held or {}


def read_json(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError):
        return None


def read_bodies(path):
    """[(position, velocity)] by id, or none where there is no file."""
    try:
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        return [([float(row[k]) for k in ("px", "py", "pz")],
                 [float(row[k]) for k in ("vx", "vy", "vz")]) for row in rows]
    except (OSError, ValueError, KeyError, TypeError):
        return []


def is_textbook(scene):
    """Whether a dial asks for a rule that is known to gain: an explicit midpoint does on springs
    that nothing damps, in energy a quarter of the fourth power of what they swing in a substep."""
    undamped = any(not spring.get("damping") for spring in scene.get("springs", []))
    if scene["settings"].get("integrator") == "midpoint" and undamped:
        return True
    return any(scene["settings"].get(dial) in values for dial, values in TEXTBOOK.items())


def step_of(scene):
    over, under = str(scene["settings"].get("dt", "1/60")).split("/")
    return float(over) / float(under)


def levels_of(made):
    """How many gaps a body of a mean mass is lifted by: one on another each adds its own."""
    if "layout stack" not in made.classes or made.mass == 0:
        return 1
    return sum(level * mass for level, mass in enumerate(made.mass_of, 1)) / made.mass


def trivial_energy(made, stats, first):
    """J: a hundredth of what falling for one step gives all bodies; who is made touching where
    none may overlap is lifted to where he rests, within the tolerance of a touch; and who is made
    inside another by what stands for its shape, out of that."""
    dt, gravity = stats.get("dt", 1 / 60), 9.81
    settings = made.scene["settings"]
    lifted = 0.0
    if settings.get("overlap", "allow") != "allow":
        inner = max((p.inner for p in made.pieces if p is not None), default=0)
        lifted = levels_of(made) * float(settings.get("toi_tolerance", 1e-4)) * inner
    if any(p.kind == "mesh" for p in made.pieces if p is not None):
        lifted += first.get("max_overlap_m", 0)
    return made.mass * (0.01 * (gravity * dt) ** 2 / 2 + gravity * lifted)


def borne_energy(made, stats, held):
    """J: what soft contacts may hold under the weight of all, as deep as any is found and allowed
    to be, at the end or as a gain began, for who is let go gives back what he held then; penalty
    forces, whose springs are as soft as the step asks, as deep as any is. No ledger has these
    springs: motion and height take turns with what they hold."""
    settings = made.scene["settings"]
    if settings.get("overlap", "allow") != "allow" or \
            not any(made.scene.get("gravity", [0, 0, -9.81])):
        return 0.0
    deep = max(stats["max_overlap_m"], held.get("max_overlap_m", 0))
    if settings.get("response") != "penalty":
        deep = min(deep, OVERLAP_SHARE * thickness_of(made))
    return made.mass * 9.81 * deep / 2


def lag_energy(made, run):
    """J: how far what bodies that fall have, told at one moment, may be off: their velocities are half
    a substep behind."""
    substep = run.stats["dt"] / float(run.stats["dials"]["substeps"])
    return sum(9.81 * substep / 2 * math.sqrt(2 * made.mass * stats["kinetic_energy_j"])
               for stats in (run.before, run.stats))


def thickness_of(made):
    return max((2 * p.inner for p in made.pieces if p is not None), default=0)


def ending(run):
    if run.timed_out:
        return "hang: no end within its time"
    if run.code < 0:
        return f"crash: signal {-run.code}"
    named = {1: "quarantine", 2: "refusal", 3: "fault"}
    if run.code != 0:
        return f"{named.get(run.code, 'exit')}: code {run.code}: {run.words}"
    if not run.stats or not run.bodies:
        return "output: stats or final states are missing"
    return None


def not_finite(made, run):
    for i, (position, velocity) in enumerate(run.bodies):
        if not all(math.isfinite(x) for x in position + velocity):
            return f"finite: body {i} is not"
    return None


def through_floor(made, run):
    if made.floor is None:
        return None
    # A spring may carry who hangs on it round the rim of what ends.
    springs = made.scene.get("springs", []) if made.has_rim else []
    sprung = {spring[end] for spring in springs for end in ("a", "b")} - {None}
    for i, (piece, (position, _)) in enumerate(zip(made.pieces, run.bodies)):
        body = made.scene["bodies"][i]
        if piece is None or "pivot" in body or body.get("name") in sprung:
            continue
        # The middle of what is not convex may lie beside it.
        bound = piece.radius if piece.kind in ("mesh", "compound") else 0.0
        deep = made.floor(position[0], position[1]) - position[2]
        if bound < deep < math.inf:
            return f"floor: body {i}, {piece.kind}, is {deep:.3g} m below it"
    return None


def energy_made(made, run):
    stats = run.stats
    if is_textbook(made.scene):
        return None
    greatest = max(stats["greatest_kinetic_energy_j"], run.before.get("kinetic_energy_j", 0))
    bound = ENERGY_SHARE * greatest + borne_energy(made, stats, run.held) \
        + trivial_energy(made, stats, run.first)
    gained = stats["energy_gained_j"]
    if not gained <= bound:
        return f"energy: {gained:.3g} J made, of {greatest:.3g} J at most in motion"
    if made.driven or not run.before:
        return None
    total = [s["kinetic_energy_j"] + s["potential_energy_j"] for s in (run.before, stats)]
    net = total[1] - total[0]
    lag = lag_energy(made, run)
    if not net <= bound + lag:
        return f"energy net: {net:.3g} J more at the end, of {greatest:.3g} J at most in motion"
    if made.kept and not -net <= KEPT_SHARE * greatest + lag:
        return f"energy kept: {-net:.3g} J of {greatest:.3g} J lost where nothing takes any"
    return None


def not_at_rest(made, run):
    stats = run.stats
    if is_textbook(made.scene) or stats["steps"] * stats["dt"] < made.rests_by:
        return None
    speed = math.sqrt(2 * stats["kinetic_energy_j"] / made.mass)
    if stats["bodies_awake"] > 0 and not speed <= REST_SPEED:
        return f"rest: {speed:.3g} m/s on the average, long after all should lie still"
    return None


def too_deep(made, run):
    """Of scenes at rest: a blow may press bodies deeper for a step."""
    stats = run.stats
    if stats["steps"] * stats["dt"] < made.rests_by or "response" in made.scene["settings"]:
        return None
    thick = thickness_of(made)
    if any(p.kind == "mesh" for p in made.pieces if p is not None):
        return None  # stand-ins of meshes have an error of their own
    deep = stats["max_overlap_m"]
    if not deep <= OVERLAP_SHARE * thick + 1e-5:
        return f"overlap: {deep:.3g} m at rest, of bodies {thick:.3g} m thick"
    return None


def too_slow(made, run):
    ms = run.stats["ms_per_step"]
    times = run.stretch * (SLOW_TIMES if made.slow else 1)
    if ms["greatest"] > ANY_STEP_MS * times:
        return f"slow: a step took {ms['greatest']:.3g} ms"
    if ms["p99"] > STEP_MS * times:
        return f"slow: one in a hundred steps took {ms['p99']:.3g} ms or more"
    return None


def failures(made, run, timed=True):
    """What was not kept, gravest first; each begins with the name of its kind."""
    end = ending(run)
    if end:
        return [end]
    judges = [not_finite, through_floor, energy_made, not_at_rest, too_deep]
    if timed:
        judges.append(too_slow)
    return [found for found in (judge(made, run) for judge in judges) if found]
