"""The 3-RRR mechanism: flexible or rigid passive links, ideal or loose joints.

The cables of Exudyn measure the axial strain by |r'| - 1 and bending by the curvature, those of Looselink by
(r'.r' - 1)/2 and r''. Both agree for small strain.
"""

from numpy.polynomial import Chebyshev, Polynomial

from mechanism import HEAVY, add_contact, derivative, item, new_system, np, point, polynomial, prescribe, push

LEGS = ["1", "2", "3"]


class Motion:
    """The motion that the scene prescribes, and the places of the ideal mechanism at t = 0."""

    def __init__(self, scene):
        self.scene = scene
        drive = scene["drives"]["input"]
        self.path = drive["path"]
        assert drive["body"] == "platform" and self.path["type"] == "circle" and self.path["theta"] == 0.0

    def platform(self, t):
        """Return the prescribed place of the platform; t may be complex."""
        angle = 2.0 * np.pi * self.path["frequency"] * t + self.path["phase"]
        x, y = self.path["center"]
        return np.array([x + self.path["radius"] * np.cos(angle), y + self.path["radius"] * np.sin(angle)])

    def crank_end(self, leg, t):
        """Return the place of joint B, from the law of cosines; t may be complex."""
        ground = point(self.scene, "ground", "A" + leg)
        crank = self.scene["bodies"]["crank" + leg]["length"]
        link = self.scene["bodies"]["link" + leg]["length"]
        corner = point(self.scene, "platform", "C" + leg)
        x, y = (self.platform(t).T + corner - ground).T
        square = x * x + y * y
        along = (crank**2 + square - link**2) / (2.0 * square)
        across = self.elbow(leg) * np.sqrt(crank**2 / square - along**2)
        return (np.array([along * x - across * y, along * y + across * x]).T + ground).T

    def crank_angle(self, leg, t):
        """Return the angle of a crank; t may be complex, close to 0."""
        ground = point(self.scene, "ground", "A" + leg)
        crank = self.scene["bodies"]["crank" + leg]["length"]
        x, y = self.crank_end(leg, 0.0) - ground
        start = np.arctan2(y, x)
        x, y = (self.crank_end(leg, t).T - ground).T
        return start - 1j * np.log((x + 1j * y) / crank * np.exp(-1j * start))

    def elbow(self, leg):
        """Return the side of the line AC on which the sketch has the elbow."""
        ground = point(self.scene, "ground", "A" + leg)
        line = self.platform(0.0) + point(self.scene, "platform", "C" + leg) - ground
        sketch = np.array(self.scene["initial"]["sketch"]["B" + leg]) - ground
        return np.sign(line[0] * sketch[1] - line[1] * sketch[0])


def taylor(function, reach):
    """Return the Taylor coefficients at t = 0 of an analytic function of time, for use up to t = reach.

    They are the Fourier coefficients on a circle in the complex plane, and exact to rounding.
    """
    radius = 4.0 * reach
    circle = np.exp(2j * np.pi * np.arange(64) / 64)
    return (np.fft.fft(function(radius * circle)).real / 64 / radius ** np.arange(64))[..., :32]


def shortest(coefficients, reach, precision):
    """Return the polynomial of least degree that agrees with a Taylor series up to t = reach."""
    function = Polynomial(coefficients)
    samples = np.linspace(0.0, reach, 201)
    for degree in range(2, 16):
        fit = Chebyshev.interpolate(function, degree, domain=[0.0, reach])
        if np.abs(fit(samples) - function(samples)).max() < precision:
            return list(fit.convert(kind=Polynomial).coef)
    raise ValueError("the series needs too high a degree")


def build(study, scene, force_driven):
    """Build the mechanism and return (container, system, nodes, prescribed place of the platform).

    The centre of the platform is at the mean of the nodes. The motion of the cranks is prescribed by constraints or, for
    explicit methods, by the torques that very heavy cranks need for it. The functions of time are polynomials that agree
    with the inverse kinematics to rounding: Exudyn evaluates them faster than the closed form.
    """
    motion = Motion(scene)
    container, system = new_system()
    fixed = system.AddNode(item.NodePointGround())
    ground = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0))

    ideal = contact_of(scene, "C1") is None
    if not ideal:
        nodes, corners = add_platform(system, scene, motion)
    ends = []
    for leg in LEGS:
        body = scene["bodies"]["link" + leg]
        series = taylor(lambda t: motion.crank_end(leg, t), study["duration"])
        start = series[:, 0]
        end = motion.platform(0.0) + point(scene, "platform", "C" + leg)
        start_velocity = series[:, 1]
        end_velocity = taylor(motion.platform, study["duration"])[:, 1]
        add_link = add_flexible_link if body["model"] == "flexible" else add_rigid_link
        link, markers = add_link(system, scene, body, start, end, start_velocity, end_velocity)

        contact = contact_of(scene, "B" + leg)
        if contact:
            bearing = add_crank(system, study, scene, motion, leg, ground, force_driven)
            add_contact(system, scene, contact, bearing, markers[0])
        else:
            assert not force_driven  # explicit methods do not take ideal joints
            for axis in range(2):
                prescribe_series(system, study, ground, link[0], axis, series[axis])
        if ideal:
            ends.append((link[-1], markers[1]))
        else:
            add_contact(system, scene, contact_of(scene, "C" + leg), corners[leg], markers[1])
    if ideal:
        nodes = join_ends(system, scene, ends)
    return container, system, nodes, motion.platform


def prescribe_series(system, study, ground, node, coordinate, series):
    """Prescribe a coordinate of a node by its Taylor series, whose first term is the reference value."""
    offset = shortest([0.0, *series[1:]], study["duration"], 1e-16)
    prescribe(system, ground, node, coordinate, polynomial(offset), polynomial(derivative(offset)))


def add_crank(system, study, scene, motion, leg, ground, force_driven):
    """Add a crank with the prescribed motion. Return the marker of its end."""
    series = taylor(lambda t: motion.crank_angle(leg, t), study["duration"])
    node = system.AddNode(item.Node1D(referenceCoordinates=[series[0]], initialVelocities=[series[1]]))
    crank = system.AddObject(
        item.ObjectRotationalMass1D(
            nodeNumber=node,
            inertia=HEAVY if force_driven else 1.0,  # without effect under a constraint
            referencePosition=[*point(scene, "ground", "A" + leg), 0.0],
        )
    )
    if force_driven:
        acceleration = shortest(derivative(derivative(series)), study["duration"], 1e-12)
        push(system, node, 0, polynomial([HEAVY * c for c in acceleration]))
    else:
        prescribe_series(system, study, ground, node, 0, series)
    length = scene["bodies"]["crank" + leg]["length"]
    return system.AddMarker(item.MarkerBodyPosition(bodyNumber=crank, localPosition=[length, 0.0, 0.0]))


def contact_of(scene, joint):
    """Return the contact of a loose joint, or None if the joint is ideal."""
    table = scene["joints"][joint]
    return scene["contacts"][table["contact"]] if table["model"] == "clearance" else None


def plate_of(scene):
    """Return mass and circumradius of the platform."""
    plate = scene["bodies"]["platform"]["plate"]
    assert plate["shape"] == "equilateral_triangle"
    radius = plate["circumradius"]
    area = 0.75 * np.sqrt(3.0) * radius**2
    return scene["materials"][plate["material"]]["density"] * plate["thickness"] * area, radius


def add_platform(system, scene, motion):
    """Add the platform at its prescribed place and velocity. Return its nodes and the markers of its corners."""
    mass, radius = plate_of(scene)
    velocity = taylor(motion.platform, 1e-2)[:, 1]
    node = system.AddNode(
        item.NodeRigidBody2D(referenceCoordinates=[*motion.platform(0.0), 0.0], initialVelocities=[*velocity, 0.0])
    )
    body = system.AddObject(item.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=0.25 * mass * radius**2))
    corners = {
        leg: system.AddMarker(
            item.MarkerBodyPosition(bodyNumber=body, localPosition=[*point(scene, "platform", "C" + leg), 0.0])
        )
        for leg in LEGS
    }
    return [node], corners


def join_ends(system, scene, ends):
    """Join the ends of flexible links, given as nodes and markers, to a platform that has no coordinates of its own.

    The mass matrix is that of the plate in the places of its corners, and three distances make it rigid. A rigid body
    with three revolute joints is the same, but needs three more coordinates and three more constraints.
    """
    mass, radius = plate_of(scene)
    nodes, markers = zip(*ends)
    places = np.diag([1.0, 1.0, 0.0, 0.0])  # of the four coordinates of a node, two are places and two are slopes
    matrix = mass / 12.0 * np.kron(np.ones((3, 3)) + np.eye(3), places)
    system.AddObject(item.ObjectGenericODE2(nodeNumbers=list(nodes), massMatrix=matrix))
    side = np.sqrt(3.0) * radius
    for first, second in [(0, 1), (1, 2), (2, 0)]:
        pair = [markers[first], markers[second]]
        system.AddObject(item.ObjectConnectorDistance(markerNumbers=pair, distance=side))
    return list(nodes)


def section_of(scene, body):
    """Return mass per length, axial stiffness and bending stiffness of a link."""
    section = scene["sections"][body["section"]]
    material = scene["materials"][body["material"]]
    area = section["width"] * section["height"]
    moment = section["height"] * section["width"] ** 3 / 12.0
    modulus = material["youngs_modulus"]
    return material["density"] * area, modulus * area, modulus * moment


def turning(start, end, start_velocity, end_velocity):
    """Return the unit vector along a rigid link and its angular velocity."""
    chord = end - start
    length = np.hypot(*chord)
    relative = end_velocity - start_velocity
    return chord / length, (chord[0] * relative[1] - chord[1] * relative[0]) / length**2


def add_rigid_link(system, scene, body, start, end, start_velocity, end_velocity):
    """Add a thin rigid bar. Return its nodes and the markers of its ends."""
    length = body["length"]
    mass = section_of(scene, body)[0] * length
    along, speed = turning(start, end, start_velocity, end_velocity)
    middle = 0.5 * (start_velocity + end_velocity)
    node = system.AddNode(
        item.NodeRigidBody2D(
            referenceCoordinates=[*(0.5 * (start + end)), np.arctan2(along[1], along[0])],
            initialVelocities=[*middle, speed],
        )
    )
    bar = system.AddObject(item.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=mass * length**2 / 12.0))
    markers = [
        system.AddMarker(item.MarkerBodyPosition(bodyNumber=bar, localPosition=[x, 0.0, 0.0]))
        for x in [-0.5 * length, 0.5 * length]
    ]
    return [node], markers


def add_flexible_link(system, scene, body, start, end, start_velocity, end_velocity):
    """Add a straight chain of ANCF cables, at first in rigid motion. Return its nodes and the markers of its ends."""
    count = body["elements"]
    density, axial, bending = section_of(scene, body)
    along, speed = turning(start, end, start_velocity, end_velocity)
    turn = speed * np.array([-along[1], along[0]])
    nodes = []
    for k in range(count + 1):
        place = start + (end - start) * k / count
        velocity = start_velocity + (end_velocity - start_velocity) * k / count
        nodes.append(
            system.AddNode(
                item.NodePoint2DSlope1(
                    referenceCoordinates=[*place, *along], initialVelocities=[*velocity, *turn]
                )
            )
        )
    for pair in zip(nodes, nodes[1:]):
        system.AddObject(
            item.ObjectANCFCable2D(
                length=body["length"] / count,
                massPerLength=density,
                axialStiffness=axial,
                bendingStiffness=bending,
                nodeNumbers=list(pair),
            )
        )
    markers = [system.AddMarker(item.MarkerNodePosition(nodeNumber=node)) for node in [nodes[0], nodes[-1]]]
    return nodes, markers
