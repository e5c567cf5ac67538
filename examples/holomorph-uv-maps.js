// SPDX-License-Identifier: GPL-3.0-or-later
// A job type of Flamenco 3: copy this file to the folder `scripts` beside the Flamenco Manager. The workers need the command
// `holomorph` and see the sources and the output folder under the same paths.

const JOB_TYPE = {
    label: "Holomorph UV Maps",
    description: "Conformal UV maps of a library of meshes, and an overview of them",
    settings: [
        { key: "sources", type: "string", subtype: "dir_path", required: true,
          description: "Folder with mesh files and .blend files; or a pattern, or a list of both" },
        { key: "output", type: "string", subtype: "dir_path", required: true,
          description: "Folder for the results, outside of the sources; what is there already is not done again" },
        { key: "recipe", type: "string", subtype: "file_path", default: "",
          description: "TOML file: which maps, tilings, levels of detail and files" },
        { key: "shares", type: "int32", default: 8, propargs: { min: 1, max: 1000 },
          description: "Number of tasks that share the work" },
        { key: "memory", type: "string", default: "",
          description: "Memory that an asset may take, such as 4G; by default a share of the machine's" },
        { key: "seconds", type: "int32", default: 1800, propargs: { min: 1 },
          description: "Time that an asset may take" },
        { key: "program", type: "string", default: "holomorph", visible: "web",
          description: "The command on the workers; may be a variable of the manager, such as {holomorph}" },
    ]
};

function compileJob(job) {
    const settings = job.settings;
    const shares = [];
    for (let number = 1; number <= settings.shares; number++) {
        const task = author.Task(`share-${number}-of-${settings.shares}`, "misc");
        task.addCommand(batchCommand(settings, ["--share", `${number}/${settings.shares}`]));
        job.addTask(task);
        shares.push(task);
    }
    const overview = author.Task("overview", "misc");
    overview.addCommand(batchCommand(settings, []));
    for (const task of shares) {
        overview.addDependency(task);
    }
    job.addTask(overview);
}

// Assets that are not done stand in the overview: they are no reason to do a task again, or to leave the others.
function batchCommand(settings, share) {
    let args = ["batch", settings.sources, "--out", settings.output, "--report-only", "--time", `${settings.seconds}`];
    if (settings.recipe) {
        args = args.concat(["--recipe", settings.recipe]);
    }
    if (settings.memory) {
        args = args.concat(["--memory", settings.memory]);
    }
    return author.Command("exec", { exe: settings.program, args: args.concat(share) });
}
