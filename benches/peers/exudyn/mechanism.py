"""What both mechanisms share: scene files, prescribed motion, contacts, solver settings and runs."""

import contextlib
import sys
import time
import tomllib
from pathlib import Path

sys.exudynFast = True  # the build without range checks and with AVX2

with contextlib.redirect_stdout(sys.stderr):  # the import prints a line
    import exudyn as exu
    from exudyn import itemInterface as item
    from exudyn.advancedUtilities import CreateSymbolicUserFunction
import numpy as np

exu.config.suppressWarnings = True
ROOT = Path(__file__).resolve().parents[3]

EXPLICIT = {"ExplicitMidpoint", "RK33", "RK44", "RK67", "ODE23", "DOPRI5", "VelocityVerlet"}

# Mass [kg] or inertia [kg m^2] of a part that follows its prescribed motion by force. A contact force of 10 kN
# accelerates it by less than 1e-9 m/s^2, which moves it by less than 1e-13 m in 15 ms.
HEAVY = 1e13


# --- scenes and studies ---


def read_study(name):
    """Read a study and its scene, with the changes that the study makes to the scene."""
    path = ROOT / "studies" / f"{name}.toml"
    study = tomllib.loads(path.read_text())
    scene = tomllib.loads((path.parent / study["scene"]).resolve().read_text())
    for change in study.get("set", []):
        keys, value = change.split("=")
        *tables, last = keys.split(".")
        table = scene
        for key in tables:
            table = table[key]
        table[last] = tomllib.loads(f"value = {value}")["value"]
    return study, scene


def point(scene, body, name):
    """Return a point of a body in its own frame."""
    place = scene["bodies"][body]["points"][name]
    if isinstance(place, dict):
        angle = np.radians(place["degrees"])
        return place["radius"] * np.array([np.cos(angle), np.sin(angle)])
    return np.array(place, float)


def contact_stiffness(scene, contact):
    """Return K = 4/(3 (h_i + h_j)) sqrt(R_i R_j/(R_i - R_j)) with h = (1 - nu^2)/E."""
    compliance = 0.0
    for key in ["bearing_material", "journal_material"]:
        material = scene["materials"][contact[key]]
        compliance += (1.0 - material["poissons_ratio"] ** 2) / material["youngs_modulus"]
    bearing = contact["bearing_radius"]
    journal = bearing - contact["clearance"]
    return 4.0 / (3.0 * compliance) * np.sqrt(bearing * journal / contact["clearance"])


# --- parts of a model ---


def new_system():
    """Return an empty system. The container must live as long as the system."""
    container = exu.SystemContainer()
    return container, container.AddSystem()


def add_contact(system, scene, contact, bearing, journal):
    """Add a journal in a circular bearing, both given as markers.

    The law of Hunt and Crossley has chi = 3 (1 - e)/2, that of Lankarani and Nikravesh chi = 3 (1 - c_e^2)/4. With
    e = (1 + c_e^2)/2 both are the same law. One thing differs: Exudyn does not clamp a negative force, a pull, at zero.
    """
    assert contact["law"] == "lankarani_nikravesh" and "friction" not in contact
    radius = contact["bearing_radius"]
    clearance = contact["clearance"]
    # gap, tangential velocity, impact velocity, plastic overlap
    state = [clearance, 0.0, 0.0, 0.0]
    data = system.AddNode(item.NodeGenericData(initialCoordinates=state, numberOfDataCoordinates=4))
    return system.AddObject(
        item.ObjectContactSphereSphere(
            markerNumbers=[journal, bearing],
            nodeNumber=data,
            spheresRadii=[radius - clearance, radius],
            isHollowSphere1=True,
            contactStiffness=contact_stiffness(scene, contact),
            contactStiffnessExponent=contact["exponent"],
            impactModel=1,
            restitutionCoefficient=0.5 * (1.0 + contact["restitution"] ** 2),
            minimumImpactVelocity=contact["impact_velocity_floor"],
        )
    )


def polynomial(coefficients):
    """Return c_0 + c_1 t + ... as a function of numbers or symbolic expressions."""

    def value(t):
        total = coefficients[-1]
        for coefficient in reversed(coefficients[:-1]):
            total = coefficient + t * total
        return total

    return value


def derivative(coefficients):
    """Return the coefficients of the derivative of a polynomial."""
    return [k * c for k, c in enumerate(coefficients)][1:]


def prescribe(system, ground, node, coordinate, offset, rate):
    """Prescribe a coordinate of a node, less its reference value, by a constraint."""
    marker = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
    constraint = system.AddObject(item.ObjectConnectorCoordinate(markerNumbers=[ground, marker]))

    def place(mbs, t, itemNumber, lOffset):
        return offset(t)

    def speed(mbs, t, itemNumber, lOffset):
        return rate(t)

    for key, function in [("offsetUserFunction", place), ("offsetUserFunction_t", speed)]:
        symbolic = CreateSymbolicUserFunction(system, function, key, constraint)
        system.SetObjectParameter(constraint, key, symbolic)


def push(system, node, coordinate, force):
    """Apply a force of time to a coordinate of a node."""
    marker = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
    load = system.AddLoad(item.LoadCoordinate(markerNumber=marker, load=0.0))

    def call(mbs, t, load):
        return force(t)

    symbolic = CreateSymbolicUserFunction(system, call, "loadUserFunction", load)
    system.SetLoadParameter(load, "loadUserFunction", symbolic)


# --- runs ---


class Failed(Exception):
    """The solver gave up."""


def settings(study, method):
    """Return the settings of a run.

    `method` is a table with the key `solver`, and `step` or, for DOPRI5 and ODE23, `tolerance`. The other keys are
    options:

    * `cut` (false): steps are cut where a contact changes, which Exudyn calls recommended step size;
    * `contact` (1): the error of the contact state that ends a cut, in Exudyn's unit, stiffness times gap;
    * `spectral_radius` (1): of the generalised-alpha method;
    * `newton` (1e-4): the norm of the residual that Newton's method leaves, in N;
    * `sparse` (false): sparse instead of dense matrices.
    """
    result = exu.SimulationSettings()
    result.solution.file.write = False
    result.solution.sensors.active = False
    result.parallel.numberOfThreads = 1
    sparse = method.get("sparse", False)
    result.linearSolver.solverType = exu.LinearSolverType.EigenSparse if sparse else exu.LinearSolverType.EXUdense

    integration = result.timeIntegration
    integration.endTime = study["duration"]
    integration.verboseMode = 0
    # shorter steps of implicit methods lose too many digits in accelerations
    integration.minimumStepSize = 1e-15 if method["solver"] in EXPLICIT else 1e-10
    integration.explicit.useLieGroupIntegration = False  # there are no rotations in space
    integration.explicit.computeEndOfStepAccelerations = False  # nothing needs them
    if "tolerance" in method:
        longest = study["interval"]
        integration.automaticStepSize = True
        integration.stepSizeMaxIncrease = 10.0
        integration.absoluteTolerance = method["tolerance"]
        integration.relativeTolerance = 0.0
    else:
        longest = method["step"]
        integration.automaticStepSize = False
    integration.numberOfSteps = round(study["duration"] / longest)
    integration.adaptiveStep = method.get("cut", False)
    integration.adaptiveStepRecoverySteps = 1  # after a cut the step grows at once
    integration.discontinuous.useRecommendedStepSize = method.get("cut", False)
    integration.discontinuous.iterationTolerance = method.get("contact", 1.0)

    newton = integration.newton
    newton.relativeTolerance = 1e-14  # the absolute tolerance decides
    newton.absoluteTolerance = method.get("newton", 1e-4)
    newton.useModifiedNewton = True  # the Jacobian is kept as long as Newton's method converges
    integration.generalizedAlpha.spectralRadius = method.get("spectral_radius", 1.0)
    return result


def solve(system, run_settings, method):
    """Run an assembled system and return the processor time in seconds."""
    solver = getattr(exu.DynamicSolverType, method["solver"])
    begin = time.process_time()
    try:
        system.SolveDynamic(run_settings, solverType=solver)
    except (exu.ExudynError, ValueError) as error:
        raise Failed(str(error)) from None
    return time.process_time() - begin
