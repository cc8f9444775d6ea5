rule contact:
    "Loaded tooth contact"
    input:
        pinion=compliance("pinion"),
        face_gear=compliance("face_gear"),
    output:
        ltca="results/{case}/contact/ltca.csv",
        by_torque="results/{case}/contact/by_torque.csv",
        pressure="results/{case}/contact/pressure.npz",
        loads="results/{case}/contact/loads.npz",
        vtu="results/{case}/contact/pressure.vtu",
        manifest="results/{case}/contact/contact.provenance.json",
    resources:
        mem_mb=4000,
        runtime=30,
    script:
        "../scripts/contact.py"


rule contact_figures:
    "Transmission error, load share and contact pattern"
    input:
        ltca=shared("contact", "ltca"),
        pressure=shared("contact", "pressure"),
    output:
        **pictures("contact", "contact_curves", "contact_pattern"),
        manifest="results/{case}/figures/contact.provenance.json",
    script:
        "../scripts/contact_figures.py"
