include: "functions/contact_studies.smk"


rule contact_studies:
    "Contact of the studies' cases side by side"
    input:
        **studied_contacts(),
    output:
        table="results/{case}/contact/studies.csv",
        manifest="results/{case}/contact/studies.provenance.json",
    params:
        points=studied_names(),
    script:
        "../scripts/contact_studies.py"


rule contact_studies_figures:
    "Figures of the contact of the studies' cases side by side"
    input:
        **studied_contacts(),
    output:
        **picture_lists("contact", CONTACT_STUDY_FIGURES),
        manifest="results/{case}/figures/contact_studies.provenance.json",
    params:
        points=studied_names(),
        titles=CONTACT_STUDIES,
        torque=studied_torque(),
    script:
        "../scripts/contact_studies_figures.py"
