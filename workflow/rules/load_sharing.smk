include: "functions/load_sharing.smk"


rule load_sharing:
    "Load sharing at the nominal speed"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        curve="results/{case}/load_sharing/nominal.csv",
        summary="results/{case}/load_sharing/nominal_summary.csv",
        manifest="results/{case}/load_sharing/load_sharing.provenance.json",
    script:
        "../scripts/load_sharing.py"


rule load_sharing_reference:
    "Load sharing at rest, running slowly and over a range of speeds"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        reference="results/{case}/load_sharing/reference.csv",
        speeds="results/{case}/load_sharing/speed_range.csv",
        manifest="results/{case}/load_sharing/reference.provenance.json",
    resources:
        runtime=15,
    script:
        "../scripts/load_sharing_reference.py"


rule hunting:
    "Quasi-static load sharing over the hunting cycle"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        meshes="results/{case}/load_sharing/hunting_meshes.csv",
        groups="results/{case}/load_sharing/hunting_groups.csv",
        bearings="results/{case}/load_sharing/bearings.csv",
        cycles="results/{case}/load_sharing/hunting_cycles.csv",
        scan="results/{case}/load_sharing/bearing_stiffness.csv",
        sensitivity="results/{case}/load_sharing/sensitivity.csv",
        manifest="results/{case}/load_sharing/hunting.provenance.json",
    script:
        "../scripts/hunting.py"


rule following:
    "Load sharing of the running machine while its runouts turn"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        groups="results/{case}/load_sharing/following_groups.csv",
        meshes="results/{case}/load_sharing/following_meshes.csv",
        manifest="results/{case}/load_sharing/following.provenance.json",
    script:
        "../scripts/following.py"


rule hunting_figures:
    "Layout of the machine with its forces, load sharing over the hunting cycle"
    input:
        meshes=rules.hunting.output.meshes,
        groups=rules.hunting.output.groups,
        bearings=rules.hunting.output.bearings,
        cycles=rules.hunting.output.cycles,
        scan=rules.hunting.output.scan,
        sensitivity=rules.hunting.output.sensitivity,
    output:
        **pictures("load_sharing", "layout", "hunting", "bearing_stiffness", "sensitivity"),
        manifest="results/{case}/figures/hunting_figures.provenance.json",
    params:
        machine=needs("machine"),
    script:
        "../scripts/hunting_figures.py"


rule load_sharing_summary:
    "Load sharing of all studies"
    input:
        summaries=sharing_files("summary", nominal=True),
        curves=sharing_files("curve"),
    output:
        summary="results/{case}/load_sharing/summary.csv",
        studies=[f"results/{{case}}/load_sharing/{study.name}.csv" for study in STUDIES],
        manifest="results/{case}/load_sharing/summary.provenance.json",
    params:
        points=STUDY_POINTS,
        labels=list(STUDY_LABELS.values()),
        studies=[study.name for study in STUDIES],
    script:
        "../scripts/load_sharing_summary.py"


rule load_sharing_figures:
    "Load sharing over a mesh cycle, study by study"
    input:
        studies=rules.load_sharing_summary.output.studies,
        summary=rules.load_sharing_summary.output.summary,
    output:
        **picture_lists("load_sharing", SHARING_FIGURES),
        manifest="results/{case}/figures/load_sharing_figures.provenance.json",
    params:
        titles=[(study.title, study.figures is not None) for study in STUDIES],
        kinds=SHARING_KINDS,
        values=sections("tooth_pair", "transmission", "mesh_stiffness"),
    script:
        "../scripts/load_sharing_figures.py"
