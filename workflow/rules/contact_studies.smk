include: "functions/contact_studies.smk"


rule contact_studies:
    "Contact of the studies' cases side by side"
    input:
        pair=studied("geometry", "pair"),
        ltca=studied("contact", "ltca"),
        by_torque=studied("contact", "by_torque"),
        pressure=studied("contact", "pressure"),
    output:
        **picture_lists("contact", CONTACT_STUDY_FIGURES),
        table="results/{case}/contact/studies.csv",
        manifest="results/{case}/contact/studies.provenance.json",
    params:
        points=studied_names(),
        titles=CONTACT_STUDIES,
        torque=studied_torque(),
    script:
        "../scripts/contact_studies.py"
