"""Does `tungsten --plan-cost` tell what an error costs, and which method is the cheapest? Its prices beside renders."""

import numpy as np

from darts_bench.measures import grey, own_error
from darts_bench.plots import panels
from darts_bench.program import Bench, Scene

TITLE = "Does `--plan-cost` tell what an error costs?"
# Small passes: every method has many of them in little time.
PHOTONS = ["integrator.photon_count=10000", "integrator.volume_photon_count=5000"]
OWN = ["cornell-fog", "mirror-fog", "two-pulses", "glass-tank", "fogged-box", "lamp-in-fog", "milk-behind-glass", "cloud-in-haze", "two-peaks",
       "amber-half-space", "volumetric-caustic", "layered-tissue", "laser-in-fog", "several-lights"]
OTHERS = ["cbox", "dragon"]
SEEDS = 2
MOST = 1 << 22  # passes that are looked at
MARKERS = {"points": "o", "beams": "s", "paths": "^"}


def scenes(bench):
    side = bench.short(48, 16)
    found = [Scene.own(name, side, *PHOTONS) for name in bench.short(OWN, ["cornell-fog", "several-lights"])]
    others = [Scene.others(name, side) for name in bench.short(OTHERS, [])]
    return found + [Scene(s.name, s.file, s.resolution, (*s.settings, *PHOTONS)) for s in others if s]


class Law:
    """The prices of a method: errors and CPU seconds of means of 1, 2, ... passes."""

    def __init__(self, method):
        passes = np.arange(1.0, MOST + 1)

        def total(name):
            return method[name]["first"] * np.cumsum(passes ** method[name]["exponent"])

        noise, bias = total("relative variance of a pass") / passes**2, total("relative bias of a pass") / passes
        self.errors = np.minimum.accumulate(np.sqrt(noise + bias**2))
        self.seconds = method["CPU seconds before the first"] + total("CPU seconds of a pass")
        # The renderer's own, which goes on to 10^9 passes; none: never.
        self.prices = {price["error"]: price["CPU seconds"] or np.inf for price in method.get("prices", [])}

    def price(self, error):
        """CPU seconds; infinite where so many passes do not suffice."""
        at = int(np.searchsorted(-self.errors, -error))
        return self.seconds[at] if at < MOST else np.inf


class Measured:
    """What renders of several seeds took: noise by their spread, bias by their own estimate."""

    def __init__(self, renders):
        before = np.mean([r.stats["stages"].get("prepare", {}).get("CPU seconds", 0.0) for r in renders])
        # The pilot's passes are without what estimating their bias takes.
        passes = sum(r.cpu[-1] for r in renders)
        extra = sum(r.stats["stages"].get("bias", {}).get("CPU seconds", 0.0) for r in renders) / passes
        self.cpu = before + (1 - extra) * np.mean([r.cpu[-1] for r in renders])
        self.passes = np.mean([r.passes[-1] for r in renders])
        greys = np.array([grey(r.image()) for r in renders])
        self.noise = float(np.sqrt(np.var(greys, axis=0, ddof=1).mean()) / greys.mean())
        self.told = own_error(renders)
        self.bias = float(np.mean([r.entries[-1].get("relative bias") or 0.0 for r in renders]))
        self.error = float(np.hypot(self.noise, self.bias))

    def seconds(self, error):
        """CPU seconds if the mean squared error fell as 1 / time."""
        return self.cpu * (self.error / error) ** 2


def compared(bench, scene):
    """(laws, measurements, reasons why methods have no price) by method of one scene."""
    plan = bench.plan_cost(scene, bench.short(2, 0.3))["methods"]
    laws = {method["name"]: Law(method) for method in plan if "prices" in method}
    cells = {method["name"]: (scene, [*method["settings"].split(), "renderer.spp_step=1"]) for method in plan if "prices" in method}
    found = bench.interleaved(cells, SEEDS, cpu=bench.short(1.5, 0.5), options=["--bias"])
    measured = {name: Measured(renders) for name, renders in found.items() if min(r.passes[-1] for r in renders) > 3}
    return laws, measured, {method["name"]: method["refused because"] for method in plan if "prices" not in method}


def prediction_rows(scene, laws, measured):
    for name, m in measured.items():
        price = laws[name].price(m.error)
        yield [scene, name, f"{m.passes:.0f}", f"{m.error:.3f}", f"{m.told / m.noise:.2f}", f"{m.bias:.3f}", f"{price:.3g}",
               f"{m.cpu:.3g}", f"{price / m.cpu:.2f}"], price / m.cpu


def choice_of(laws, measured):
    """At the least error that was reached: what is told to be the cheapest, what is, and how many times as much it costs."""
    cheapest = min(measured, key=lambda name: measured[name].seconds(1.0))
    error = measured[cheapest].error
    choice = min(measured, key=lambda name: laws[name].price(error))
    return error, choice, cheapest, measured[choice].seconds(error) / measured[cheapest].cpu


def one_percent(laws, measured):
    """The cheapest by prices, its price of 1 %, and what its own render says if its MSE falls as 1 / time."""
    name = min(laws, key=lambda name: laws[name].prices[0.01])
    price = laws[name].prices[0.01]
    least = min(measured, key=lambda name: measured[name].seconds(0.01))
    return [*((name, f"{price:.3g}") if np.isfinite(price) else ("none", "never")), least, f"{measured[least].seconds(0.01):.3g}"]


def picture(bench, points):
    figure, axes = panels(1, 5.4, 4.0)
    for name in dict.fromkeys(name for name, *_ in points):
        mine = [(cpu, ratio) for n, cpu, ratio in points if n == name]
        kind = "sliced primitives" if name not in MARKERS else name
        axes[0].semilogy(*zip(*mine), linestyle="none", marker=MARKERS.get(name, "d"), markersize=4, label=kind)
    axes[0].axhspan(0.5, 2, color="tab:green", alpha=0.12, linewidth=0)
    axes[0].axhline(1, color="0.3", linewidth=0.8)
    axes[0].set_xscale("log")
    axes[0].set_xlabel("error reached", fontsize=9)
    axes[0].set_ylabel("CPU seconds predicted / measured", fontsize=9)
    axes[0].legend(fontsize=7)
    bench.plot(figure, bench.name)


def failures(rows, choices):
    """Where the promise is not kept, named."""
    off = [f"{row[0]} by {row[1]} ({ratio:.2f})" for row, ratio in rows if not 0.5 < ratio < 2]
    wrong = [f"{row[0]} ({row[4]} times)" for row, times in choices if times > 1.5]
    return (f"Predictions within a factor of two: {len(rows) - len(off)} of {len(rows)}, the median is "
            f"{np.median([ratio for _, ratio in rows]):.2f} of what was measured. Choices that are the cheapest or within 1.5 times of it: "
            f"{len(choices) - len(wrong)} of {len(choices)}.\n\nOff by more than two: {'; '.join(off) or 'none'}. "
            f"Choices that cost more than 1.5 times the cheapest: {'; '.join(wrong) or 'none'}.")


def run(bench: Bench):
    rows, choices, prices, refused, points = [], [], [], [], []
    for scene in scenes(bench):
        laws, measured, reasons = compared(bench, scene)
        refused += [[scene.name, name, reason] for name, reason in reasons.items()]
        mine = list(prediction_rows(scene.name, laws, measured))
        rows += mine
        points += [(row[1], float(row[3]), ratio) for row, ratio in mine]
        if measured:
            error, choice, cheapest, times = choice_of(laws, measured)
            choices.append(([scene.name, f"{error:.3f}", choice, cheapest, f"{times:.2f}"], times))
            prices.append([scene.name, *one_percent(laws, measured)])
    picture(bench, points)
    side = bench.short(48, 16)
    bench.write(TITLE, f"{len(prices)} scenes, {side} x {side} pixels, passes of 10 000 and 5000 light paths. Pilots of {bench.short(2, 0.3)} s for each "
                f"method beside renders of {bench.short(1.5, 0.5)} CPU seconds, {SEEDS} seeds, with `--bias`: the price of the error that they reached, and "
                "the CPU seconds that it took them (what estimating the bias takes left out). Errors: noise by the spread of the seeds, and "
                "the render's own estimate of its bias; relative to the mean, rms over pixels and frames.",
                failures(rows, choices), "![predicted over measured](accuracy-cost.svg)",
                "## What 1 % costs", "CPU seconds at that resolution, by the method that prices call the cheapest, and as the cheapest of the renders would "
                "take if its MSE fell as 1 / time, which a bias does not. Both go beyond what was rendered by factors of up to a "
                "million: a bias below a pilot's noise, or a bright sample that it has not seen, is in neither.",
                "By scene: " + bench.keep("one-percent", ["scene", "cheapest by its price", "CPU s by its price", "cheapest of the renders", "CPU s of the renders"],
                                          prices) + ".",
                "## Figures", "- " + bench.keep("predictions", ["scene", "method", "passes", "error", "own standard error / spread of seeds", "own bias",
                                                                "predicted, CPU s", "measured, CPU s", "ratio"], [row for row, _ in rows])
                + ": prices of the error that renders reached, and what it took them\n- "
                + bench.keep("choices", ["scene", "error", "its choice", "cheapest", "cost over the cheapest"], [row for row, _ in choices])
                + ": at the least error that a method reached in its time; the cost of the others there from their MSE × CPU s\n- "
                + bench.keep("refused", ["scene", "method", "why"], refused) + ": methods without a price, and why")
