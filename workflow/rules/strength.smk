include: "functions/strength.smk"


rule root_stress:
    "Root stress of both gears"
    input:
        pinion=compliance("pinion"),
        face_gear=compliance("face_gear"),
        loads=shared("contact", "loads"),
    output:
        summary="results/{case}/strength/root_stress.csv",
        passage="results/{case}/strength/passage.csv",
        along_face="results/{case}/strength/along_face.csv",
        stress="results/{case}/strength/root_stress.npz",
        vtu="results/{case}/strength/root_stress.vtu",
        manifest="results/{case}/strength/root_stress.provenance.json",
    script:
        "../scripts/root_stress.py"


rule root_stress_figures:
    "Root stress over a passage and along the face"
    input:
        passage=shared("root_stress", "passage"),
        along_face=shared("root_stress", "along_face"),
    output:
        **pictures("strength", "root_stress_passage", "root_stress_along_face"),
        manifest="results/{case}/figures/root_stress.provenance.json",
    script:
        "../scripts/root_stress_figures.py"


rule duty_loads:
    "Loads of the running machine in every bin of the duty cycle"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        duty_loads="results/{case}/strength/duty_loads.csv",
        duty_spectrum="results/{case}/strength/duty_spectrum.csv",
        manifest="results/{case}/strength/duty_loads.provenance.json",
    script:
        "../scripts/duty_loads.py"


rule rating:
    "Safety and life of the tooth pair"
    input:
        stress=shared("root_stress", "stress"),
        by_torque=shared("contact", "by_torque"),
        duty_spectrum=machine_loads("duty_spectrum"),
    output:
        safety="results/{case}/strength/safety.csv",
        rating="results/{case}/strength/rating.csv",
        damage="results/{case}/strength/damage.csv",
        curves="results/{case}/strength/curves.csv",
        manifest="results/{case}/strength/rating.provenance.json",
    script:
        "../scripts/rating.py"


rule rating_figures:
    "Bins of the duty cycle beside the stress that may be repeated so often, and their damage"
    input:
        rating=rules.rating.output.rating,
        damage=rules.rating.output.damage,
        curves=rules.rating.output.curves,
    output:
        **pictures("strength", "life", "damage"),
        manifest="results/{case}/figures/rating.provenance.json",
    script:
        "../scripts/rating_figures.py"


rule dynamic_root_stress:
    "Root stress of the running machine"
    input:
        response="results/{case}/dynamics/response.csv",
        stress=shared("root_stress", "stress"),
        by_torque=shared("contact", "by_torque"),
    output:
        dynamic_stress="results/{case}/strength/dynamic_stress.csv",
        manifest="results/{case}/strength/dynamic_stress.provenance.json",
    script:
        "../scripts/dynamic_root_stress.py"


rule stress_over_speed:
    "Root stress and pressure over the speed range"
    input:
        sweep="results/{case}/dynamics/sweep.csv",
        branches=stable_branches,
        stress=shared("root_stress", "stress"),
        by_torque=shared("contact", "by_torque"),
        harmonics=shared("stiffness", "harmonics"),
    output:
        stress_over_speed="results/{case}/strength/stress_over_speed.csv",
        manifest="results/{case}/strength/stress_over_speed.provenance.json",
    script:
        "../scripts/stress_over_speed.py"


rule stress_over_speed_figure:
    "Root stress, pressure and dynamic factor over speed"
    input:
        table=rules.stress_over_speed.output.stress_over_speed,
    output:
        **pictures("strength", "stress_over_speed"),
        manifest="results/{case}/figures/stress_over_speed.provenance.json",
    params:
        **values_of(speed_rpm="dynamics.speed_rpm"),
    script:
        "../scripts/stress_over_speed_figure.py"
