"""The slider-crank: a crank at constant speed, a rod, and a slider with play in its pin."""

from mechanism import HEAVY, add_contact, exu, item, new_system, np, point, prescribe, push


def build(study, scene, force_driven):
    """Build the mechanism and return (container, system, nodes, reference place of the slider).

    The coordinates of the rod are those of its big end, which the crank carries. Two constraints prescribe its place;
    for explicit methods it is so heavy that it follows the force that its path needs. The slider has one coordinate.
    """
    crank = scene["bodies"]["crank"]["length"]
    rod = scene["bodies"]["rod"]
    slider = scene["bodies"]["slider"]
    constant, speed = scene["drives"]["motor"]["angle"]["coefficients"]
    assert constant == 0.0 and rod["points"]["big_end"][1] == 0.0 and rod["points"]["small_end"][1] == 0.0
    center = -rod["points"]["big_end"][0]  # of mass, from the big end
    length = center + rod["points"]["small_end"][0]

    container, system = new_system()
    big_end = system.AddNode(
        item.NodeRigidBody2D(
            referenceCoordinates=[crank, 0.0, 0.0],
            # crank and rod are aligned, and the small end is at rest
            initialVelocities=[0.0, crank * speed, -crank * speed / length],
        )
    )
    mass = rod["mass"] + (HEAVY if force_driven else 0.0)
    body = system.AddObject(
        item.ObjectRigidBody2D(
            nodeNumber=big_end,
            mass=mass,
            inertia=rod["inertia"] + rod["mass"] * center**2,
            centerOfMass=[rod["mass"] * center / mass, 0.0],
        )
    )
    sine, cosine = exu.symbolic.sin, exu.symbolic.cos
    if force_driven:
        pull = -mass * crank * speed**2
        push(system, big_end, 0, lambda t: pull * cosine(speed * t))
        push(system, big_end, 1, lambda t: pull * sine(speed * t))
    else:
        fixed = system.AddNode(item.NodePointGround())
        ground = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0))
        prescribe(
            system, ground, big_end, 0,
            lambda t: crank * (cosine(speed * t) - 1.0), lambda t: -crank * speed * sine(speed * t),
        )
        prescribe(
            system, ground, big_end, 1,
            lambda t: crank * sine(speed * t), lambda t: crank * speed * cosine(speed * t),
        )

    start = scene["initial"]["bodies"]["slider"]["x"]
    assert abs(start - crank - length) < 1e-15
    node = system.AddNode(item.Node1D(referenceCoordinates=[0.0]))
    block = system.AddObject(
        item.ObjectMass1D(nodeNumber=node, mass=slider["mass"], referencePosition=[start, 0.0, 0.0])
    )
    bearing = system.AddMarker(item.MarkerBodyPosition(bodyNumber=block))
    journal = system.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=[length, 0.0, 0.0]))
    add_contact(system, scene, scene["contacts"]["pin"], bearing, journal)
    return container, system, [node], start
